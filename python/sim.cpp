#include <memory>
#include <optional>

#include "ensonify/python/arrays.hpp"
#include "ensonify/python/unlocked.hpp"
#include "ensonify/sim/scene_view.hpp"
#include "ensonify/sim/voxelize.hpp"

namespace ensonify::python {
namespace {

std::unique_ptr<OccupancyGrid> truth_of(const Scene& scene, std::optional<double> resolution_m) {
  const Unlocked unlocked;
  return std::make_unique<OccupancyGrid>(voxelize(scene, resolution_m.value_or(scene.grid_resolution_m)).grid);
}

py::array picture_of(const Scene& scene, const std::string& view, int width, int height, double azimuth_deg,
                     double elevation_deg) {
  if (width < 1 || height < 1 || width > 16384 || height > 16384) {
    throw py::value_error("width and height must be 1 to 16384 pixels");
  }
  if (!std::isfinite(azimuth_deg) || !std::isfinite(elevation_deg)) {
    throw py::value_error("azimuth_deg and elevation_deg must be finite");
  }
  Camera camera;
  if (view == "plan") {
    camera = plan_camera(scene);
  } else if (view == "side") {
    camera = side_camera(scene);
  } else if (view == "oblique") {
    camera = oblique_camera(scene, radians(azimuth_deg), radians(elevation_deg), static_cast<double>(width) / height);
  } else {
    throw py::value_error(fmt::format("view '{}' is none of oblique, plan, side", view));
  }
  Image2<Rgb> picture;
  {
    const Unlocked unlocked;
    picture = draw_scene(scene, camera, width, height);
  }
  static_assert(sizeof(Rgb) == 3);
  py::array_t<std::uint8_t> array({picture.rows(), picture.columns(), 3});
  const auto* bytes = reinterpret_cast<const std::uint8_t*>(picture.pixels().data());
  std::copy_n(bytes, array.size(), array.mutable_data());
  return array;
}

}  // namespace

void bind_sim(py::module_& m) {
  m.def("voxelize", &truth_of, py::arg("scene"), py::arg("resolution_m") = py::none(),
        "Ground-truth occupancy of a scene over its bounds; cells as wide as the scene says unless told. Raises\n"
        "ConfigError for more than 64 million cells.");
  m.def("draw_scene", &picture_of, py::arg("scene"), py::arg("view") = "oblique", py::kw_only(), py::arg("width") = 800,
        py::arg("height") = 600, py::arg("azimuth_deg") = -60, py::arg("elevation_deg") = 30,
        "A shaded picture, uint8 [height, width, 3] (red, green, blue), as people would see the place without water:\n"
        "view is oblique, plan or side.");
}

}  // namespace ensonify::python
