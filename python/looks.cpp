#include "ensonify/python/looks.hpp"

#include <sstream>

#include "ensonify/generators/explore_files.hpp"
#include "ensonify/mapping/map_conversion.hpp"
#include "ensonify/python/arrays.hpp"
#include "ensonify/python/poses.hpp"
#include "ensonify/python/sources.hpp"

namespace ensonify::python {
namespace {

py::array columns_array(const Slice& slice) {
  static_assert(sizeof(ColumnState) == 1);
  return py::array_t<std::uint8_t>({slice.frame.size[1], slice.frame.size[0]},
                                   reinterpret_cast<const std::uint8_t*>(slice.columns.data()));
}

void bind_look(py::module_& m) {
  py::class_<PyLook>(m, "Look", "A ping that was mapped, and what the vehicle knows by then.")
      .def_readonly("step", &PyLook::step)
      .def_readonly("time_s", &PyLook::time_s, "Of the simulated clock.")
      .def_property_readonly(
          "raw", [](const py::object& self) { return view_of(self.cast<const PyLook&>().ping.raw, self); },
          "uint8 [bins, beams].")
      .def_property_readonly(
          "filtered", [](const py::object& self) { return view_of(self.cast<const PyLook&>().ping.filtered, self); },
          "float32 [bins, beams], 0..255: what the mapper got.")
      .def_property_readonly(
          "pose_est", [](const PyLook& l) { return matrix_of(l.T_world_sonar_est); },
          "Where the vehicle believes to be, float64 [4, 4].")
      .def_property_readonly(
          "pose", [](const PyLook& l) { return matrix_of(l.T_world_sonar); },
          "Where it is: for judges, not for planners. float64 [4, 4].")
      .def_property_readonly(
          "columns", [](const PyLook& l) { return columns_array(l.columns); },
          "uint8 [y, x]: 0 unknown, 1 free, 2 occupied, at the vehicle's depth.")
      .def_property_readonly(
          "scores", [](const PyLook& l) { return scores_of(l.scores); },
          "dict: coverage, boundary_found, fpr, fnr of the map; clearance_m, path_m of the way.")
      .def(
          "map",
          [](const PyLook& l) {
            if (*l.grid == nullptr) throw std::runtime_error("the vehicle has moved on: ask for the map before");
            return std::make_unique<LogOddsMap>(dense_map(**l.grid));
          },
          "A copy of the map. Raises RuntimeError once the vehicle has moved on.");
}

void bind_run(py::module_& m) {
  py::class_<PyRun>(m, "Run", "How a closed loop went.")
      .def_property_readonly(
          "end", [](const PyRun& r) { return std::string(name_of(r.run.end)); },
          "all_steps, explored, plugin_done, aground or stopped.")
      .def_property_readonly(
          "steps",
          [](const PyRun& r) {
            py::list steps;
            std::istringstream lines(steps_jsonl(r.run));
            for (std::string line; std::getline(lines, line);) steps.append(from_json(line));
            return steps;
          },
          "List of dicts, one a ping; the keys are those of steps.jsonl.")
      .def_property_readonly("summary", [](const PyRun& r) { return from_json(r.summary.dump()); })
      .def_property_readonly(
          "columns", [](const PyRun& r) { return columns_array(r.run.map); },
          "uint8 [y, x]: what was scored last; 0 unknown, 1 free, 2 occupied.")
      .def(
          "map", [](const PyRun& r) { return std::make_unique<LogOddsMap>(dense_map(r.run.grid)); },
          "Our mapper's map.");
}

}  // namespace

py::dict scores_of(const ExploreStep& s) {
  py::dict scores;
  scores["coverage"] = s.scores.coverage;
  scores["boundary_found"] = s.scores.boundary_found;
  scores["fpr"] = s.scores.fpr;
  scores["fnr"] = s.scores.fnr;
  scores["clearance_m"] = s.clearance_m;
  scores["path_m"] = s.path_m;
  return scores;
}

void bind_looks(py::module_& m) {
  bind_look(m);
  bind_run(m);
}

}  // namespace ensonify::python
