#pragma once

#include <cstdint>
#include <limits>

namespace ensonify {

/// Log-odds of occupancy ln(p / (1 - p)) as integers in units of 1e-3, positive = OCCUPIED, 0 = unknown. Integers,
/// because sums of them do not depend on the order of pings.
using MilliLogOdds = std::int32_t;

/// The nearest integer: ln(.95 / .05) = 2.944439 becomes 2944, ln(.45 / .55) = -0.200671 becomes -201.
/// Throws ConfigError unless 0 < p < 1.
MilliLogOdds milli_log_odds(double probability_occupied);
double probability_occupied(MilliLogOdds log_odds);

/// What one ping adds to a cell that it found free or occupied. The defaults are those of Lin et al. (ICRA 2023), who
/// write them for the probability of being free: .55 and .05.
struct LogOddsStep {
  MilliLogOdds free = -201;
  MilliLogOdds occupied = 2944;
};

/// Values stay inside; the default is the range of the type, where sums saturate. OctoMap's are -2000 and 3500.
struct LogOddsLimits {
  MilliLogOdds lowest = std::numeric_limits<MilliLogOdds>::min();
  MilliLogOdds highest = std::numeric_limits<MilliLogOdds>::max();
};

/// How looks of several pings become one value.
enum class UpdateLaw : std::uint8_t {
  add,            ///< the sum of all steps: Bayes' rule for independent looks (Moravec and Elfes 1985)
  freed_for_good  ///< a look that found the cell free outweighs every echo, before and after: space carving
};

/// Throw ConfigError unless free < 0 < occupied; unless lowest < 0 < highest.
void require_valid(const LogOddsStep& step);
void require_valid(const LogOddsLimits& limits);

}  // namespace ensonify
