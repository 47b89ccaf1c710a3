#include "ensonify/generators/even_tiles.hpp"

#include <algorithm>
#include <cmath>

namespace ensonify {
namespace {

constexpr int block = 16;

Tile tile_at(const GreyImage& image, int row, int column) {
  Tile tile{{row, row + tile_rows, column, column + tile_columns}};
  double square = 0;
  for (int r = row; r < row + tile_rows; r += block) {
    for (int c = column; c < column + tile_columns; c += block) {
      double sum = 0;
      for (int i = 0; i < block; ++i) {
        for (int j = 0; j < block; ++j) sum += image.grey(r + i, c + j);
      }
      const double mean = sum / (block * block);
      tile.mean_level += mean;
      square += mean * mean;
    }
  }
  constexpr int blocks = (tile_rows / block) * (tile_columns / block);
  tile.mean_level /= blocks;
  const double variance = std::max(0.0, square / blocks - tile.mean_level * tile.mean_level);
  if (tile.mean_level > 0) tile.variation = std::sqrt(variance) / tile.mean_level;
  return tile;
}

}  // namespace

std::vector<Tile> all_tiles(const GreyImage& image) {
  std::vector<Tile> tiles;
  for (int r = 0; r + tile_rows <= image.grey.rows(); r += tile_rows) {
    for (int c = 0; c + tile_columns <= image.grey.columns(); c += tile_columns) {
      tiles.push_back(tile_at(image, r, c));
    }
  }
  return tiles;
}

std::vector<Tile> even_tiles(const std::vector<Tile>& tiles, double least_level) {
  std::vector<Tile> even;
  const auto is_even = [&](const Tile& t) { return t.mean_level >= least_level && t.variation <= most_even_variation; };
  std::copy_if(tiles.begin(), tiles.end(), std::back_inserter(even), is_even);
  if (even.size() <= static_cast<std::size_t>(most_even_tiles)) return even;
  const auto place = [](const Tile& t) { return std::pair(t.region.row0, t.region.column0); };
  std::sort(even.begin(), even.end(), [&](const Tile& a, const Tile& b) {
    return std::pair(a.variation, place(a)) < std::pair(b.variation, place(b));
  });
  even.resize(most_even_tiles);
  std::sort(even.begin(), even.end(), [&](const Tile& a, const Tile& b) { return place(a) < place(b); });
  return even;
}

}  // namespace ensonify
