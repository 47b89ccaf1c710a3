#include "ensonify/mapping/log_odds.hpp"

#include <fmt/format.h>

#include <cmath>

#include "ensonify/core/error.hpp"

namespace ensonify {

MilliLogOdds milli_log_odds(double probability_occupied) {
  if (!(probability_occupied > 0 && probability_occupied < 1)) {
    throw ConfigError(fmt::format(
        "probability {} has no log-odds; give one between 0 and 1, both excluded, such as 0.95", probability_occupied));
  }
  return static_cast<MilliLogOdds>(std::lround(1000 * std::log(probability_occupied / (1 - probability_occupied))));
}

double probability_occupied(MilliLogOdds log_odds) { return 1 / (1 + std::exp(-1e-3 * log_odds)); }

void require_valid(const LogOddsStep& step) {
  if (!(step.free < 0 && step.occupied > 0)) {
    throw ConfigError(
        fmt::format("log-odds steps free {} and occupied {} (1e-3): free must be negative and occupied "
                    "positive, since positive log-odds mean occupied; exchange or negate them",
                    step.free, step.occupied));
  }
}

void require_valid(const LogOddsLimits& limits) {
  if (!(limits.lowest < 0 && limits.highest > 0)) {
    throw ConfigError(
        fmt::format("log-odds limits {} and {} (1e-3) must have 0, the unknown, between them, "
                    "such as -2000 and 3500",
                    limits.lowest, limits.highest));
  }
}

}  // namespace ensonify
