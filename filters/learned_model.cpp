#include "ensonify/filters/learned_model.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <iterator>
#include <opencv2/imgproc.hpp>
#include <vector>

#include "ensonify/config/reader.hpp"
#include "ensonify/core/error.hpp"
#include "ensonify/filters/mat_view.hpp"

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

Network read_network(const fs::path& onnx) {
  const std::string bytes = read_bytes(onnx);
  try {
    return Network(read_onnx(bytes));
  } catch (const DataError& e) {
    throw DataError(fmt::format("{}: {}", onnx.string(), e.what()));
  }
}

/// Its first rows and columns.
Image2<float> cut(const Image2<float>& image, int rows, int columns) {
  Image2<float> part(rows, columns);
  for (int i = 0; i < rows; ++i) std::ranges::copy(image.row(i).first(columns), part.row(i).begin());
  return part;
}

}  // namespace

LearnedModel::LearnedModel(const fs::path& onnx)
    : where_(onnx.string()), network_(read_network(onnx)), card_(read_card(onnx)) {}

LearnedOutput LearnedModel::outputs(const Image2<float>& grey) const {
  const int multiple = network_.multiple();
  const auto missing = [&](int side) { return (multiple - side % multiple) % multiple; };
  const auto [low, high] = card_.input_range;
  Image2<float> image(grey.rows() + missing(grey.rows()), grey.columns() + missing(grey.columns()));
  cv::Mat padded(image.rows(), image.columns(), CV_32F, image.pixels().data());
  cv::copyMakeBorder(mat_view(grey), padded, 0, missing(grey.rows()), 0, missing(grey.columns()),
                     cv::BORDER_REFLECT_101);
  const auto scale = static_cast<float>((high - low) / 255.0), offset = static_cast<float>(low);
  for (float& pixel : image.pixels()) pixel = std::clamp(pixel, 0.0F, 255.0F) * scale + offset;
  try {
    std::vector<Image2<float>> heads = network_.run(image);
    if (image.size() != grey.size()) {
      for (Image2<float>& head : heads) head = cut(head, grey.rows(), grey.columns());
    }
    LearnedOutput output{std::move(heads.front()), {}};
    if (cleans()) output.clean = std::move(heads.back());
    return output;
  } catch (const DataError& e) {
    throw DataError(fmt::format("{}: {}", where_, e.what()));
  }
}

}  // namespace ensonify
