#include "ensonify/mapping/integrate_ping.hpp"

#include "ensonify/mapping/mark_ping.hpp"

namespace ensonify {

void integrate_ping(const PosedImage& ping, double threshold, const InverseModel& model, LogOddsGrid& grid,
                    MarkBox<Mark>& scratch) {
  require_valid(model);
  require_valid(ping, model, grid.frame());
  mark_ping(ping, classify(ping.grey, {threshold}), model, grid.frame(), scratch);
  grid.apply(scratch, step_of(model), law_of(model));
}

void integrate_ping(const PosedImage& ping, double threshold, const InverseModel& model, LogOddsGrid& grid) {
  MarkBox<Mark> scratch;
  integrate_ping(ping, threshold, model, grid, scratch);
}

}  // namespace ensonify
