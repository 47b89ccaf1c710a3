#include <fmt/format.h>

#include <cmath>
#include <mutex>
#include <optional>

#include "ensonify/mapping/insert_scan.hpp"
#include "ensonify/mapping/integrate_ping.hpp"
#include "ensonify/mapping/map_conversion.hpp"
#include "ensonify/python/arrays.hpp"
#include "ensonify/python/poses.hpp"
#include "ensonify/python/unlocked.hpp"
#include "ensonify/sensor_models/sonar_model.hpp"
#include "ensonify/sim/voxelize.hpp"

namespace ensonify::python {
namespace {

/// A map under construction, and how pings enter it.
struct Mapper {
  InverseModel model;
  double threshold;
  LogOddsGrid grid;
  MarkBox<Mark> scratch = {};
  ScanScratch scan_scratch = {};
  std::mutex mutex = {};  ///< threads may share a mapper: pings then enter one after the other
};

GridFrame frame_from(const py::object& bounds_m, double resolution_m) {
  using Matrix = py::array_t<double, py::array::c_style | py::array::forcecast>;
  const Matrix corners = Matrix::ensure(bounds_m);
  if (!corners || corners.ndim() != 2 || corners.shape(0) != 2 || corners.shape(1) != 3) {
    PyErr_Clear();
    throw py::value_error("bounds_m must be [2, 3]: the least and the greatest corner, as Scene.bounds_m");
  }
  const Vec3 low(corners.data(0)), high(corners.data(1));
  if (!low.allFinite() || !high.allFinite()) throw py::value_error("bounds_m must be finite");
  return frame_over({low, high}, resolution_m);
}

std::unique_ptr<Mapper> make_mapper(const py::object& bounds_m, double resolution_m, const std::string& model,
                                    double threshold, double p_free, double p_occupied) {
  InverseModel inverse = inverse_model_named(model);
  const LogOddsStep step{milli_log_odds(p_free), milli_log_odds(p_occupied)};
  std::visit([&](auto& any) { any.step = step; }, inverse);
  require_valid(inverse);
  if (!std::isfinite(threshold)) throw py::value_error("threshold must be finite");
  return std::unique_ptr<Mapper>(new Mapper{inverse, threshold, LogOddsGrid(frame_from(bounds_m, resolution_m))});
}

void add(Mapper& mapper, const py::object& image, const SonarModel& sonar, const py::object& pose,
         const py::object& elevation_rad) {
  PosedImage ping{grey_from(image, "image").grey, sonar.geometry, pose_from(pose), {}};
  if (!elevation_rad.is_none())
    ping.elevation_rad = image_from(require_array<float>(elevation_rad, "elevation_rad", 2));
  const Unlocked unlocked;
  const std::lock_guard alone(mapper.mutex);
  integrate_ping(ping, mapper.threshold, mapper.model, mapper.grid, mapper.scratch);
}

std::size_t add_scan(Mapper& mapper, const py::object& origin_m, const py::object& points_m,
                     std::optional<double> max_range_m, bool exact) {
  const auto points = require_array<double>(points_m, "points_m", 2);
  if (points.shape(1) != 3) throw py::value_error("points_m must have the shape [n, 3]");
  RangeScan scan{vec3_from(origin_m, "origin_m"), {}};
  for (py::ssize_t i = 0; i < points.shape(0); ++i) scan.points_m.emplace_back(points.data(i));
  ScanOptions options;
  options.rule = exact ? LineRule::exact_every_ray : LineRule::bresenham_once_an_end;
  if (max_range_m) options.max_range_m = *max_range_m;
  options.step = step_of(mapper.model);
  const Unlocked unlocked;
  const std::lock_guard alone(mapper.mutex);
  return insert_scan(scan, options, mapper.grid, mapper.scan_scratch);
}

}  // namespace

void bind_mapping(py::module_& m) {
  py::class_<Mapper>(m, "Mapper", "Builds an occupancy map from posed images or range scans.")
      .def(py::init(&make_mapper), py::arg("bounds_m"), py::arg("resolution_m"), py::kw_only(),
           py::arg("model") = "arc_shadow", py::arg("threshold") = 30, py::arg("p_free") = 0.45,
           py::arg("p_occupied") = 0.95,
           "An empty map over bounds_m [2, 3]. `model`: points, arc, arc_shadow, carve or oracle (docs/mapping.md);\n"
           "pixels of at least `threshold` grey levels echo; one look makes a cell's probability of being occupied\n"
           "p_free or p_occupied. Raises ConfigError.")
      .def("add", &add, py::arg("image"), py::arg("sonar"), py::arg("pose"), py::arg("elevation_rad") = py::none(),
           "Adds a ping. `image`: uint8, uint16 or float32 [bins, beams]; `pose`: T_world_sonar [4, 4];\n"
           "`elevation_rad`: float32 [bins, beams], for the model oracle. Raises DataError where sizes do not fit.")
      .def("add_scan", &add_scan, py::arg("origin_m"), py::arg("points_m"), py::arg("max_range_m") = py::none(),
           py::arg("exact") = true,
           "Adds a scan of a range finder: points float64 [n, 3] in the world; returns how many were used. exact: "
           "every\n"
           "cell along every ray; else Bresenham's line, one for each end cell.")
      .def(
          "map",
          [](Mapper& mapper) {
            const Unlocked unlocked;
            const std::lock_guard alone(mapper.mutex);
            return std::make_unique<LogOddsMap>(dense_map(mapper.grid));
          },
          "A copy of the map as it is.");
}

}  // namespace ensonify::python
