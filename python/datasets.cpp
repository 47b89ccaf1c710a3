#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "ensonify/core/error.hpp"
#include "ensonify/generators/dataset_reader.hpp"
#include "ensonify/generators/frame_pixels.hpp"
#include "ensonify/output/grid_files.hpp"
#include "ensonify/python/arrays.hpp"
#include "ensonify/python/sources.hpp"
#include "ensonify/python/unlocked.hpp"

namespace ensonify::python {
namespace {

class PyDataset {
 public:
  explicit PyDataset(const std::filesystem::path& folder)
      : dataset_(open_dataset(folder)), metadata_(dataset_.splits.size()) {}

  const Dataset& dataset() const { return dataset_; }

  py::dict images(const std::string& split, int number, const std::vector<std::string>& fields) {
    FrameKinds which{false, false, false, false};
    for (const std::string& field : fields) set(which, field);
    const int at = checked(split, number);
    FramePixels pixels;
    {
      const Unlocked unlocked;
      pixels = read_pixels(dataset_, at, number, which);
    }
    return dict_of(std::move(pixels), which);
  }

  py::object info(const std::string& split, int number) {
    const int at = checked(split, number);
    auto& index = metadata_[static_cast<std::size_t>(at)];
    if (!index) index = index_metadata(dataset_, at);
    return from_json(read_lines(*index, number, 1).front());
  }

  py::dict truth(const std::string& split, int number) {
    const int at = checked(split, number);
    std::vector<Channel> channels;
    {
      const Unlocked unlocked;
      channels = read_truth(dataset_, at, number);
    }
    py::dict result;
    for (auto& [name, image] : channels) result[py::str(name)] = array_of(image);
    return result;
  }

  std::unique_ptr<OccupancyGrid> grid(const std::string& place) {
    const auto path = dataset_.folder / "grids" / (place + ".npz");
    const Unlocked unlocked;
    return std::make_unique<OccupancyGrid>(read_grid(path));
  }

 private:
  static void set(FrameKinds& which, const std::string& field) {
    if (field == "raw")
      which.raw = true;
    else if (field == "clean")
      which.clean = true;
    else if (field == "mask")
      which.mask = true;
    else if (field == "labels")
      which.labels = true;
    else
      throw ConfigError(fmt::format("field '{}' is none of raw, clean, mask, labels", field));
  }

  template <typename Image>
  static py::array array_of(Image& image) {
    return moved_to_array(std::move(image));
  }

  static py::dict dict_of(FramePixels&& pixels, const FrameKinds& which) {
    py::dict result;
    if (which.raw) result["raw"] = std::visit([](auto& image) { return array_of(image); }, pixels.raw);
    if (which.clean) result["clean"] = array_of(pixels.clean);
    if (which.mask) result["mask"] = array_of(pixels.mask);
    if (which.labels) result["labels"] = array_of(pixels.labels);
    return result;
  }

  /// The split's place in the set; a number below 0 becomes one counted from the end, as Recipe.make_frame takes it.
  int checked(const std::string& split, int& number) const {
    std::vector<std::string> names;
    for (const DatasetSplit& s : dataset_.splits) names.push_back(s.name);
    const auto found = std::ranges::find(names, split);
    if (found == names.end()) {
      throw ConfigError(fmt::format("split '{}' is none of the dataset's: {}", split, fmt::join(names, ", ")));
    }
    const int at = static_cast<int>(found - names.begin());
    const int frames = dataset_.splits[static_cast<std::size_t>(at)].frames;
    if (number < 0) number += frames;
    if (number < 0 || number >= frames) {
      throw py::index_error(fmt::format("split {} has frames 0 to {}", split, frames - 1));
    }
    return at;
  }

  Dataset dataset_;
  std::vector<std::optional<MetadataIndex>> metadata_;
};

}  // namespace

void bind_datasets(py::module_& m) {
  py::class_<PyDataset>(m, "Dataset", "A finished dataset, folder or WebDataset; images are read when asked for.")
      .def(py::init<const std::filesystem::path&>(), py::arg("folder"),
           "Raises DataError: none there, unfinished, or a broken manifest.")
      .def_property_readonly("folder", [](const PyDataset& d) { return d.dataset().folder; })
      .def_property_readonly("name", [](const PyDataset& d) { return d.dataset().name; })
      .def_property_readonly(
          "root_hash", [](const PyDataset& d) { return d.dataset().root_hash; }, "Over all pixels and metadata.")
      .def_property_readonly(
          "manifest", [](const PyDataset& d) { return from_json(d.dataset().manifest); }, "dataset.json as a dict.")
      .def_property_readonly(
          "splits",
          [](const PyDataset& d) {
            py::dict splits;
            for (const DatasetSplit& s : d.dataset().splits) splits[py::str(s.name)] = s.frames;
            return splits;
          },
          "dict: frames of each split.")
      .def_property_readonly(
          "places",
          [](const PyDataset& d) {
            py::dict places;
            for (const DatasetSplit& s : d.dataset().splits) {
              py::list names;
              for (const DatasetPlace& place : s.places) names.append(place.name);
              places[py::str(s.name)] = names;
            }
            return places;
          },
          "dict: names of each split's places.")
      .def("__len__", [](const PyDataset& d) { return d.dataset().frames(); })
      .def("images", &PyDataset::images, py::arg("split"), py::arg("number"),
           py::arg("fields") = std::vector<std::string>{"raw", "clean", "mask", "labels"},
           "dict of arrays [bins, beams]: raw (uint8 or uint16), clean, mask, labels (uint8). Of a WebDataset this "
           "reads\n"
           "the frame's shard. Raises IndexError, ConfigError, DataError.")
      .def("info", &PyDataset::info, py::arg("split"), py::arg("number"),
           "The frame's line of metadata.jsonl as a dict. Numbers below 0 count from the end, here as in `images`.")
      .def("truth", &PyDataset::truth, py::arg("split"), py::arg("number"),
           "dict of the channels of truth/*.exr (docs/datasets.md). Raises DataError where the set has none.")
      .def("grid", &PyDataset::grid, py::arg("place"), "Ground truth of a place.");
}

}  // namespace ensonify::python
