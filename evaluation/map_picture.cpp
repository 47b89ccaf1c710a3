#include "ensonify/evaluation/map_picture.hpp"

#include <algorithm>

namespace ensonify {

Image2<std::uint8_t> seen_from_above(const LogOddsMap& map, const std::vector<std::uint8_t>& scored, MapSide side) {
  constexpr std::uint8_t bright = 255, dim = 90;
  const auto [nx, ny, nz] = map.frame.size;
  Image2<std::uint8_t> picture(ny, nx);
  for (int z = 0; z < nz; ++z) {
    for (int y = 0; y < ny; ++y) {
      const auto row = picture.row(ny - 1 - y);
      for (int x = 0; x < nx; ++x) {
        const std::size_t cell = map.frame.index(x, y, z);
        const float value = map.log_odds[cell];
        if (side == MapSide::free ? value >= 0 : value <= 0) continue;
        std::uint8_t& pixel = row[static_cast<std::size_t>(x)];
        pixel = std::max(pixel, scored.empty() || scored[cell] != 0 ? bright : dim);
      }
    }
  }
  return picture;
}

Image2<std::uint8_t> enlarged(const Image2<std::uint8_t>& image, int factor) {
  Image2<std::uint8_t> large(image.rows() * factor, image.columns() * factor);
  for (int r = 0; r < large.rows(); ++r) {
    for (int c = 0; c < large.columns(); ++c) large(r, c) = image(r / factor, c / factor);
  }
  return large;
}

LogOddsMap map_of_truth(const OccupancyGrid& grid) {
  LogOddsMap map{grid.frame, std::vector<float>(grid.occupancy.size(), 0.0F)};
  for (std::size_t i = 0; i < map.log_odds.size(); ++i) {
    if (grid.observable.at(i) == 0) continue;
    map.log_odds[i] = grid.occupancy[i] == static_cast<std::uint8_t>(Occupancy::free) ? -1.0F : 1.0F;
  }
  return map;
}

}  // namespace ensonify
