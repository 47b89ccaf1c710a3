#pragma once

#include "ensonify/core/posed_image.hpp"
#include "ensonify/mapping/inverse_model.hpp"
#include "ensonify/mapping/log_odds_grid.hpp"

namespace ensonify {

/// Adds one ping to the map: pixels z >= threshold (grey levels on 0..255) echo, and the model says what that means for
/// the cells; each takes at most one step. All returns of a beam count. Without limits on the log-odds the order of
/// pings does not matter; the number of threads never does. `scratch` may be any, best the last ping's. Throws
/// DataError for a ping that makes no sense (mark_ping.hpp), ConfigError for parameters out of range; the map is then
/// as before.
void integrate_ping(const PosedImage& ping, double threshold, const InverseModel& model, LogOddsGrid& grid,
                    MarkBox<Mark>& scratch);
void integrate_ping(const PosedImage& ping, double threshold, const InverseModel& model, LogOddsGrid& grid);

}  // namespace ensonify
