#pragma once

#include "ensonify/core/image2.hpp"
#include "ensonify/core/log_odds_map.hpp"

namespace ensonify {

/// Which cells a picture shows.
enum class MapSide { free, occupied };

/// A map seen from above, north (y) up, a pixel a column of cells: 255 where some scored cell of the column is on this
/// side, 90 where only cells that are not scored are, else 0. `scored`: one a cell of the map, all where empty.
Image2<std::uint8_t> seen_from_above(const LogOddsMap& map, const std::vector<std::uint8_t>& scored, MapSide side);

/// Every pixel as a square of so many.
Image2<std::uint8_t> enlarged(const Image2<std::uint8_t>& image, int factor);

/// The truth as such a map: observable cells, positive where occupied.
LogOddsMap map_of_truth(const OccupancyGrid& grid);

}  // namespace ensonify
