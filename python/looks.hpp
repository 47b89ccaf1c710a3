#pragma once

#include <memory>
#include <nlohmann/json.hpp>

#include "ensonify/generators/explore.hpp"
#include "ensonify/python/bindings.hpp"

namespace ensonify::python {

/// What there is to see after a ping was mapped. Images are its own; the map can be asked for until the vehicle moves.
struct PyLook {
  int step;
  double time_s;
  Pose T_world_sonar, T_world_sonar_est;
  ExplorePing ping;
  Slice columns;
  ExploreStep scores;
  std::shared_ptr<const LogOddsGrid*> grid;
};

struct PyRun {
  ExploreRun run;
  nlohmann::json summary;
};

py::dict scores_of(const ExploreStep& step);

/// Adds Look and Run.
void bind_looks(py::module_& m);

}  // namespace ensonify::python
