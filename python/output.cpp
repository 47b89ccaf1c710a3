#include <fmt/format.h>

#include <optional>

#include "ensonify/core/colour.hpp"
#include "ensonify/core/error.hpp"
#include "ensonify/core/log_odds_map.hpp"
#include "ensonify/output/atomic_file.hpp"
#include "ensonify/output/fan_view.hpp"
#include "ensonify/output/grid_files.hpp"
#include "ensonify/output/map_files.hpp"
#include "ensonify/output/png.hpp"
#include "ensonify/python/arrays.hpp"
#include "ensonify/python/poses.hpp"
#include "ensonify/python/unlocked.hpp"
#include "ensonify/sensor_models/sonar_model.hpp"

namespace ensonify::python {
namespace {

template <typename T>
GridFrame frame_for(const py::array_t<T>& cells, const py::object& origin_m, double resolution_m) {
  constexpr double most_cells = 1LL << 33;
  if (!(resolution_m > 0) || !std::isfinite(resolution_m)) throw py::value_error("resolution_m must be above 0");
  if (cells.size() == 0 || static_cast<double>(cells.size()) > most_cells) throw py::value_error("a grid needs cells");
  return {vec3_from(origin_m, "origin_m"),
          resolution_m,
          {static_cast<int>(cells.shape(2)), static_cast<int>(cells.shape(1)), static_cast<int>(cells.shape(0))}};
}

template <typename T>
std::vector<T> cells_from(const py::array_t<T>& array) {
  return {array.data(), array.data() + array.size()};
}

std::unique_ptr<OccupancyGrid> make_grid(const py::object& occupancy, const py::object& origin_m, double resolution_m,
                                         const py::object& observable) {
  const auto cells = require_array<std::uint8_t>(occupancy, "occupancy", 3);
  auto grid = std::make_unique<OccupancyGrid>();
  grid->frame = frame_for(cells, origin_m, resolution_m);
  grid->occupancy = cells_from(cells);
  if (std::ranges::any_of(grid->occupancy, [](std::uint8_t v) { return v > 2; })) {
    throw py::value_error("occupancy must be 0 (free), 1 (surface) or 2 (interior)");
  }
  if (!observable.is_none()) {
    grid->observable = cells_from(require_array<std::uint8_t>(observable, "observable", 3));
    if (grid->observable.size() != grid->occupancy.size()) {
      throw py::value_error("observable must have the shape of occupancy");
    }
    if (std::ranges::any_of(grid->observable, [](std::uint8_t v) { return v > 1; })) {
      throw py::value_error("observable must be 0 or 1");
    }
  }
  return grid;
}

std::unique_ptr<LogOddsMap> make_map(const py::object& log_odds, const py::object& origin_m, double resolution_m) {
  const auto cells = require_array<float>(log_odds, "log_odds", 3);
  auto map = std::make_unique<LogOddsMap>(LogOddsMap{frame_for(cells, origin_m, resolution_m), cells_from(cells)});
  if (!is_finite(*map)) throw py::value_error("log_odds must be finite; unknown cells hold 0");
  return map;
}

py::array origin_of(const GridFrame& frame) { return py::array_t<double>(3, frame.origin_m.data()); }

template <typename Class>
void add_frame(Class& type) {
  using Grid = typename Class::type;
  type.def_property_readonly(
          "origin_m", [](const Grid& g) { return origin_of(g.frame); },
          "float64 [3]: least corner of cell [0, 0, 0], world frame.")
      .def_property_readonly("resolution_m", [](const Grid& g) { return g.frame.resolution_m; })
      .def_property_readonly(
          "shape", [](const Grid& g) { return py::make_tuple(g.frame.size[2], g.frame.size[1], g.frame.size[0]); },
          "(z, y, x) cells.");
}

void save_png(const std::filesystem::path& path, const py::object& image) {
  std::vector<std::uint8_t> bytes;
  if (py::isinstance<py::array>(image) && py::reinterpret_borrow<py::array>(image).ndim() == 3) {
    const auto colour = require_array<std::uint8_t>(image, "image", 3);
    if (colour.size() == 0) throw py::value_error("an image needs pixels");
    if (colour.shape(2) != 3) throw py::value_error("a colour image must have the shape [height, width, 3]");
    Image2<Rgb> picture(static_cast<int>(colour.shape(0)), static_cast<int>(colour.shape(1)));
    std::copy_n(colour.data(), colour.size(), reinterpret_cast<std::uint8_t*>(picture.pixels().data()));
    bytes = encode_png(picture);
  } else if (py::isinstance<py::array_t<std::uint16_t>>(image)) {
    bytes = encode_png(image_from(require_array<std::uint16_t>(image, "image", 2)));
  } else {
    bytes = encode_png(image_from(require_array<std::uint8_t>(image, "image", 2)));
  }
  write_file(path, bytes);
}

/// Levels on the scale 0..255, of pixels of 8 or 16 bits.
Image2<std::uint8_t> eight_bits(const py::object& image) {
  if (!py::isinstance<py::array_t<std::uint16_t>>(image)) {
    if (py::isinstance<py::array>(image) && !py::isinstance<py::array_t<std::uint8_t>>(image)) {
      throw py::type_error(fmt::format("image must have dtype uint8 or uint16, not {}",
                                       py::str(image.attr("dtype")).cast<std::string>()));
    }
    return image_from(require_array<std::uint8_t>(image, "image", 2));
  }
  const auto fine = image_from(require_array<std::uint16_t>(image, "image", 2));
  Image2<std::uint8_t> coarse(fine.rows(), fine.columns());
  constexpr int levels = 257;  // of 16 bits in one of 8: 65535 becomes 255
  std::transform(fine.pixels().begin(), fine.pixels().end(), coarse.pixels().begin(),
                 [](std::uint16_t v) { return static_cast<std::uint8_t>((v + levels / 2) / levels); });
  return coarse;
}

py::array fan_of(const py::object& image, const SonarModel& sonar, int height) {
  const Image2<std::uint8_t> pixels = eight_bits(image);
  if (pixels.rows() != sonar.geometry.range_bins || pixels.columns() != sonar.geometry.beams()) {
    throw py::value_error(fmt::format("image must be {} bins x {} beams, as the sonar has, not {} x {}",
                                      sonar.geometry.range_bins, sonar.geometry.beams(), pixels.rows(),
                                      pixels.columns()));
  }
  if (height < 1 || height > 16384) throw py::value_error("height must be 1 to 16384 pixels");
  return moved_to_array(fan_view(pixels, sonar.geometry, height));
}

py::array polar_of(const py::object& fan, const SonarModel& sonar) {
  return moved_to_array(polar_view(image_from(require_array<float>(fan, "fan", 2)), sonar.geometry));
}

}  // namespace

void bind_output(py::module_& m) {
  py::register_exception<DiskError>(m, "DiskError", PyExc_OSError).doc() =
      "The disk does not take what is written: full, read-only, gone. An OSError.";

  py::class_<OccupancyGrid> grid(m, "Grid", "Ground-truth occupancy in cells [z, y, x].");
  add_frame(grid);
  grid.def(py::init(&make_grid), py::arg("occupancy"), py::arg("origin_m"), py::arg("resolution_m"),
           py::arg("observable") = py::none(),
           "Copies arrays uint8 [z, y, x], C-contiguous. Raises TypeError and ValueError where they do not fit.")
      .def_property_readonly(
          "occupancy",
          [](const py::object& self) {
            const auto& g = self.cast<const OccupancyGrid&>();
            return view_of(g.occupancy, g.frame, self);
          },
          "uint8 [z, y, x]: 0 free, 1 surface, 2 interior. A view.")
      .def_property_readonly(
          "observable",
          [](const py::object& self) -> py::object {
            const auto& g = self.cast<const OccupancyGrid&>();
            if (g.observable.empty()) return py::none();
            return view_of(g.observable, g.frame, self);
          },
          "uint8 [z, y, x]: 1 where some ping could see the cell; None before any ping. A view.")
      .def(
          "save",
          [](const OccupancyGrid& g, const std::filesystem::path& path, std::optional<double> slice_z_m,
             bool unobserved_is_unknown) {
            const Unlocked unlocked;
            write_grid(g, path, {slice_z_m, unobserved_is_unknown});
          },
          py::arg("path"), py::kw_only(), py::arg("slice_z_m") = py::none(), py::arg("unobserved_is_unknown") = false,
          "By extension: .npz, .bt (OctoMap), .pgm and .yaml (nav2, at slice_z_m), .ply, .vdb where built with it.")
      .def_static(
          "load",
          [](const std::filesystem::path& path) {
            const Unlocked unlocked;
            return std::make_unique<OccupancyGrid>(read_grid(path));
          },
          py::arg("path"), "From .npz. Raises DataError for a broken file.")
      .def(py::pickle(
          [](const py::object& self) {
            return py::make_tuple(self.attr("occupancy"), self.attr("origin_m"), self.attr("resolution_m"),
                                  self.attr("observable"));
          },
          [](const py::tuple& state) {
            if (state.size() != 4) throw py::value_error("no pickled Grid");
            return make_grid(state[0], state[1], state[2].cast<double>(), state[3]);
          }));

  py::class_<LogOddsMap> map(m, "Map",
                             "What a mapper believes: natural log-odds in cells [z, y, x], positive = occupied.");
  add_frame(map);
  map.def(py::init(&make_map), py::arg("log_odds"), py::arg("origin_m"), py::arg("resolution_m"),
          "Copies an array float32 [z, y, x], C-contiguous; 0 = unknown. Raises ValueError for NaN and infinity.")
      .def_property_readonly(
          "log_odds",
          [](const py::object& self) {
            const auto& g = self.cast<const LogOddsMap&>();
            return view_of(g.log_odds, g.frame, self);
          },
          "float32 [z, y, x], positive = occupied, 0 = unknown. A view.")
      .def(
          "save",
          [](const LogOddsMap& g, const std::filesystem::path& path, std::optional<double> slice_z_m) {
            const Unlocked unlocked;
            write_map(g, path, slice_z_m);
          },
          py::arg("path"), py::kw_only(), py::arg("slice_z_m") = py::none(),
          "By extension: .npz, .bt and .ot (OctoMap), .pgm and .yaml (nav2, at slice_z_m), .ply.")
      .def_static(
          "load",
          [](const std::filesystem::path& path) {
            const Unlocked unlocked;
            return std::make_unique<LogOddsMap>(read_map(path));
          },
          py::arg("path"), "From .npz. Raises DataError for a broken file.")
      .def(py::pickle(
          [](const py::object& self) {
            return py::make_tuple(self.attr("log_odds"), self.attr("origin_m"), self.attr("resolution_m"));
          },
          [](const py::tuple& state) {
            if (state.size() != 3) throw py::value_error("no pickled Map");
            return make_map(state[0], state[1], state[2].cast<double>());
          }));

  m.def("save_png", &save_png, py::arg("path"), py::arg("image"),
        "uint8 or uint16 [height, width], or uint8 [height, width, 3]; whole or not at all.");
  m.def("fan_view", &fan_of, py::arg("image"), py::arg("sonar"), py::arg("height") = 720,
        "uint8 [height, width]: the image as an operator sees it, forward up. `image`: uint8 or uint16\n"
        "[bins, beams].");
  m.def("polar_view", &polar_of, py::arg("fan"), py::arg("sonar"),
        "float32 [bins, beams] of such a view (float32 [height, width], the sonar at the middle of its lower edge, "
        "range_max "
        "at its upper one). Raises DataError where its width does not go with its height and the sonar's fan.");
}

}  // namespace ensonify::python
