#pragma once

#include <filesystem>

#include "ensonify/generators/against.hpp"
#include "ensonify/output/contact_sheet.hpp"

namespace ensonify {

/// Real pings beside simulated ones.
struct RealFindings {
  SideFigures simulated, real;
  ContactSheet pictures;  ///< a ping of each side, and what the learned filter makes of it, where it is bundled
};

/// A folder of raw pings (PNG) beside three of a simulated Oculus at rest over the bundled rough tank
/// (docs/validation.md), which are written to `simulated`. Throws DataError: no such folder, no pings in it.
RealFindings beside_real_pings(const std::filesystem::path& real, const std::filesystem::path& simulated);

}  // namespace ensonify
