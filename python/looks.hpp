#pragma once

#include <memory>
#include <nlohmann/json.hpp>

#include "ensonify/generators/explore.hpp"
#include "ensonify/python/bindings.hpp"

namespace ensonify::python {

/// Lends a grid to looks, which find a null pointer once it is gone.
class LentGrid {
 public:
  explicit LentGrid(const LogOddsGrid& grid) : grid_(std::make_shared<const LogOddsGrid*>(&grid)) {}
  ~LentGrid() { *grid_ = nullptr; }
  LentGrid(const LentGrid&) = delete;
  LentGrid& operator=(const LentGrid&) = delete;

  const std::shared_ptr<const LogOddsGrid*>& pointer() const { return grid_; }

 private:
  std::shared_ptr<const LogOddsGrid*> grid_;
};

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
