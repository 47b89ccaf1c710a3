#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "ensonify/generators/against.hpp"

namespace ensonify {

/// The band of ping-to-ping correlation in noise: of the darkest tiles.
constexpr const char* noise_band = "interping_corr_noise";

/// Bounds of one figure, as acceptance.json has them; none: not bounded on that side.
struct AcceptanceBand {
  std::string id, quantity;
  std::optional<double> min, max;
  bool max_exclusive = false;
};

/// Reads the bands of a folder's acceptance.json; none where it has no such file. Throws DataError naming file and rule
/// where it is broken or asks for a figure that is not known.
std::vector<AcceptanceBand> read_acceptance_bands(const std::filesystem::path& folder);

/// The bands' ids without bounds: what is printed where there is no acceptance.json.
std::vector<AcceptanceBand> unbounded_bands();

/// The figure of a band: of even tiles, and of neighbouring pings; none where the side has none.
std::optional<double> band_value(const SideFigures& side, const std::string& id);

/// The same of a region; of neighbouring pings, its own correlation.
std::optional<double> band_value(const RegionFigures& region, const std::string& id);

/// Whether the value lies within the bounds. None without value or bounds, and for pings between which the sonar moved.
std::optional<bool> inside(const AcceptanceBand& band, const SideFigures& side);

}  // namespace ensonify
