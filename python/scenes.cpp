#include <fmt/format.h>

#include "ensonify/config/library.hpp"
#include "ensonify/output/atomic_file.hpp"
#include "ensonify/python/arrays.hpp"
#include "ensonify/python/poses.hpp"
#include "ensonify/python/sources.hpp"
#include "ensonify/python/unlocked.hpp"
#include "ensonify/scenes/scene.hpp"
#include "ensonify/scenes/scene_export.hpp"
#include "ensonify/scenes/water.hpp"

namespace ensonify::python {
namespace {

std::shared_ptr<Scene> make_scene(const py::object& source, std::uint64_t layout) {
  const ConfigSource from = source_from(source, "scene");
  auto scene = std::make_shared<Scene>();
  {
    const Unlocked unlocked;
    *scene = open_scene(from, layout);
  }
  for (const std::string& warning : scene->warnings) {
    if (PyErr_WarnEx(PyExc_UserWarning, warning.c_str(), 1) != 0) throw py::error_already_set();
  }
  return scene;
}

py::array corners(const Eigen::AlignedBox3d& box) {
  py::array_t<double> array({2, 3});
  auto at = array.mutable_unchecked<2>();
  for (int axis = 0; axis < 3; ++axis) {
    at(0, axis) = box.min()[axis];
    at(1, axis) = box.max()[axis];
  }
  return array;
}

std::size_t triangles(const Scene& scene) {
  std::size_t count = 0;
  for (const Instance& instance : scene.instances) count += scene.meshes[instance.mesh].triangles.size();
  return count;
}

void save(const Scene& scene, const std::filesystem::path& path, bool with_surface) {
  const Unlocked unlocked;
  write_file(path, export_scene(scene, path.extension().string(), with_surface));
}

}  // namespace

void bind_scenes(py::module_& m) {
  py::class_<Scene, std::shared_ptr<Scene>>(m, "Scene",
                                            "A place: meshes, materials, water. Frame: metres, z = 0 at the surface.")
      .def(
          py::init(&make_scene), py::arg("source"), py::arg("layout") = 0,
          "From a bundled name (scene_names()), a YAML file, a dict of its keys, or a mesh file (.obj .ply .stl .gltf\n"
          ".glb .dae). `layout` varies what a scene leaves to chance. Raises ConfigError and DataError; warns of what\n"
          "looks odd in a mesh.")
      .def_readonly("name", &Scene::name)
      .def_readonly("title", &Scene::title)
      .def_readonly("layout", &Scene::layout)
      .def_readonly("grid_resolution_m", &Scene::grid_resolution_m, "Cell size of the place's ground truth.")
      .def_property_readonly(
          "bounds_m", [](const Scene& s) { return corners(s.bounds_m); },
          "float64 [2, 3]: least and greatest corner of what the ground truth covers.")
      .def_property_readonly(
          "navigable_m", [](const Scene& s) { return corners(s.navigable_m); },
          "float64 [2, 3]: where a vehicle may be.")
      .def_property_readonly(
          "waypoints",
          [](const Scene& s) {
            py::list poses;
            for (const Pose& pose : s.waypoints) poses.append(matrix_of(pose));
            return poses;
          },
          "The place's own trajectory: list of T_world_sonar, float64 [4, 4].")
      .def_property_readonly(
          "objects",
          [](const Scene& s) {
            std::vector<std::pair<std::string, std::string>> list;
            for (const Instance& i : s.instances) {
              list.emplace_back(i.name, s.materials[i.material].name);
            }
            return list;
          },
          "(name, material) of everything in it; Ping.instance counts in this order.")
      .def_property_readonly("triangles", &triangles)
      .def_property_readonly("sound_speed_mps", [](const Scene& s) { return sound_speed_mps(s.water); })
      .def("save", &save, py::arg("path"), py::arg("with_surface") = false,
           "Writes one mesh file: .glb .obj .ply or .stl; with or without the water's surface.")
      .def("__repr__", [](const Scene& s) {
        return fmt::format("<ensonify.Scene {} layout {}: {} objects, {} triangles>", s.name, s.layout,
                           s.instances.size(), triangles(s));
      });
  m.def(
      "scene_names", [] { return library_names("scenes"); }, "Names of the bundled scenes.");
}

}  // namespace ensonify::python
