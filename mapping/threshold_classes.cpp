#include "ensonify/mapping/threshold_classes.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "ensonify/core/error.hpp"

namespace ensonify {
namespace {

std::uint8_t class_of(double level, const std::vector<double>& thresholds) {
  return static_cast<std::uint8_t>(std::upper_bound(thresholds.begin(), thresholds.end(), level) - thresholds.begin());
}

Image2<std::uint8_t> classes(const Image2<std::uint8_t>& grey, const std::vector<double>& thresholds) {
  std::array<std::uint8_t, 256> table;
  for (std::size_t level = 0; level < table.size(); ++level)
    table[level] = class_of(static_cast<double>(level), thresholds);
  Image2<std::uint8_t> out(grey.rows(), grey.columns());
  std::transform(grey.pixels().begin(), grey.pixels().end(), out.pixels().begin(),
                 [&](std::uint8_t z) { return table[z]; });
  return out;
}

Image2<std::uint8_t> classes(const Image2<float>& grey, const std::vector<double>& thresholds) {
  Image2<std::uint8_t> out(grey.rows(), grey.columns());
  for (int row = 0; row < grey.rows(); ++row) {
    for (int column = 0; column < grey.columns(); ++column) {
      const float z = grey(row, column);
      if (std::isnan(z)) {
        throw DataError(
            fmt::format("pixel in range bin {}, beam {} is no number; a map takes grey levels on 0..255", row, column));
      }
      out(row, column) = class_of(static_cast<double>(z), thresholds);
    }
  }
  return out;
}

}  // namespace

void require_valid(const std::vector<double>& thresholds) {
  if (thresholds.empty() || thresholds.size() > most_thresholds) {
    throw ConfigError(
        fmt::format("{} thresholds; a map takes at least one and at most {}", thresholds.size(), most_thresholds));
  }
  for (std::size_t i = 0; i < thresholds.size(); ++i) {
    if (!std::isfinite(thresholds[i]) || (i > 0 && thresholds[i] <= thresholds[i - 1])) {
      throw ConfigError(
          fmt::format("threshold {} at place {} of the list: thresholds must be numbers, each above the one "
                      "before; sort them",
                      thresholds[i], i));
    }
  }
}

ClassImage classify(const GreyPixels& grey, const std::vector<double>& thresholds) {
  require_valid(thresholds);
  return std::visit(
      [&](const auto& image) -> ClassImage {
        if (image.empty()) throw DataError("empty image; a ping needs at least one range bin and one beam");
        return {classes(image, thresholds), class_of(0, thresholds)};
      },
      grey);
}

}  // namespace ensonify
