#include "ensonify/filters/learned_model.hpp"

#include <fmt/format.h>

#include <fstream>
#include <iterator>
#include <mutex>
#include <opencv2/dnn.hpp>
#include <opencv2/imgproc.hpp>
#include <vector>

#include "ensonify/config/reader.hpp"
#include "ensonify/core/error.hpp"
#include "ensonify/filters/mat_view.hpp"
#include "ensonify/filters/onnx_rules.hpp"

namespace ensonify {
namespace fs = std::filesystem;
namespace {

constexpr std::uintmax_t most_bytes = std::uintmax_t{1} << 30;

std::string read_bytes(const fs::path& path) {
  std::error_code no_throw;
  const std::uintmax_t size = fs::file_size(path, no_throw);
  std::ifstream file(path, std::ios::binary);
  if (no_throw || !file) throw DataError(fmt::format("{}: can not be read", path.string()));
  if (size > most_bytes) throw DataError(fmt::format("{}: is above 1 GiB; no model is", path.string()));
  return {std::istreambuf_iterator<char>(file), {}};
}

ModelCard read_card(const fs::path& onnx) {
  const fs::path path = fs::path(onnx).replace_extension(".json");
  if (!fs::exists(path)) {
    throw DataError(
        fmt::format("{}: is missing; a model needs the card that its training wrote beside it", path.string()));
  }
  try {
    Reader file = Reader::from_file(path);
    file.integer("schema", 1, 1);
    ModelCard card;
    card.network = file.choice("network", {"unet", "pix2pix"});
    const std::vector<double> range = file.numbers("input_range", 2, {-1e6, 1e6});
    card.input_range = {range[0], range[1]};
    card.threshold = file.number("threshold", {0, 1});
    for (const char* for_people : {"heads", "ngf", "parameters", "sha256", "license", "metrics", "training"})
      file.has(for_people);
    file.finish();
    return card;
  } catch (const ConfigError& e) {
    throw DataError(e.what());
  }
}

}  // namespace

struct LearnedModel::Networks {
  std::string where, bytes;
  ModelCard card;
  int multiple = 1;
  std::mutex mutex;
  std::vector<cv::dnn::Net> idle;

  cv::dnn::Net take() {
    {
      const std::lock_guard lock(mutex);
      if (!idle.empty()) {
        cv::dnn::Net net = std::move(idle.back());
        idle.pop_back();
        return net;
      }
    }
    cv::dnn::Net net = cv::dnn::readNetFromONNX(bytes.data(), bytes.size());
    net.setPreferableBackend(cv::dnn::DNN_BACKEND_OPENCV);
    net.setPreferableTarget(cv::dnn::DNN_TARGET_CPU);
    return net;
  }
  void give_back(cv::dnn::Net net) {
    const std::lock_guard lock(mutex);
    idle.push_back(std::move(net));
  }
};

LearnedModel::LearnedModel(const fs::path& onnx) : networks_(std::make_unique<Networks>()) {
  networks_->where = onnx.string();
  networks_->bytes = read_bytes(onnx);
  try {
    networks_->multiple = check_network(read_onnx(networks_->bytes)).multiple;
    networks_->give_back(networks_->take());
  } catch (const DataError& e) {
    throw DataError(fmt::format("{}: {}", onnx.string(), e.what()));
  } catch (const cv::Exception& e) {
    throw DataError(fmt::format("{}: no network that OpenCV can run ({})", onnx.string(), e.err));
  }
  networks_->card = read_card(onnx);
}

LearnedModel::~LearnedModel() = default;

const ModelCard& LearnedModel::card() const { return networks_->card; }

Image2<float> LearnedModel::probability(const Image2<float>& grey) const {
  const auto missing = [&](int side) {
    return (networks_->multiple - side % networks_->multiple) % networks_->multiple;
  };
  const auto [low, high] = networks_->card.input_range;
  cv::Mat image;
  cv::copyMakeBorder(mat_view(grey), image, 0, missing(grey.rows()), 0, missing(grey.columns()),
                     cv::BORDER_REFLECT_101);
  image = cv::min(cv::max(image, 0.0), 255.0);
  image.convertTo(image, CV_32F, (high - low) / 255.0, low);
  const std::array<int, 4> shape{1, 1, image.rows, image.cols};
  try {
    cv::dnn::Net net = networks_->take();
    net.setInput(image.reshape(1, 4, shape.data()));
    const cv::Mat output = net.forward();
    if (output.type() != CV_32F || output.total() != image.total() || !output.isContinuous()) {
      throw DataError(fmt::format("{}: gives an output of another size than its input", networks_->where));
    }
    const cv::Mat plane(image.rows, image.cols, CV_32F, const_cast<float*>(output.ptr<float>()));
    Image2<float> result = from_mat(plane(cv::Rect(0, 0, grey.columns(), grey.rows())));
    networks_->give_back(std::move(net));
    return result;
  } catch (const cv::Exception& e) {
    throw DataError(fmt::format("{}: does not run on an image of {} x {} ({})", networks_->where, grey.rows(),
                                grey.columns(), e.err));
  }
}

}  // namespace ensonify
