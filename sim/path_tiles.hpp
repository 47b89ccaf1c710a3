#pragma once

#include <cstdint>
#include <vector>

namespace ensonify {

/// The unit square of a PathFan in tiles of 8 points each: a grid of equal cells, each halved as often as told, in
/// elevation and azimuth in turn. Points lie at places that never change (a (0,3,2)-net, shifted by a hash of the
/// tile): the same pose sees the same multipath.
class PathTiles {
 public:
  static constexpr int points = 8;  ///< of a tile

  struct Grid {
    int columns = 4, rows = 1;  ///< powers of two
    int cells() const { return columns * rows; }
    int cell_of(float u, float v) const;
  };

  struct Tile {
    int cell;
    float u, v, width, height;  ///< lower corner and size
    std::uint32_t address;
  };

  struct Point {
    float u, v;
    float kind, along, turn;  ///< numbers in 0..1 for walks from here
  };

  /// `halvings`: of every cell.
  PathTiles(const Grid& grid, std::vector<int> halvings);
  /// About `budget` tiles, at least one a cell, the more the larger the square root of the cell's energy: blocks of the
  /// image differ by orders of magnitude, and none should be much noisier than the others.
  static PathTiles for_energy(const Grid& grid, const std::vector<float>& energy, int budget);

  const Grid& grid() const { return grid_; }
  /// Neighbours mostly follow each other (Morton order of the cells).
  const std::vector<Tile>& tiles() const { return tiles_; }
  Point point(const Tile& tile, int q) const;
  /// Of the tiles of a cell.
  float width(int cell) const { return 1.0f / static_cast<float>(grid_.columns << (halvings_[cell] / 2)); }
  float height(int cell) const { return 1.0f / static_cast<float>(grid_.rows << ((halvings_[cell] + 1) / 2)); }

 private:
  Grid grid_;
  std::vector<int> halvings_;
  std::vector<Tile> tiles_;
};

}  // namespace ensonify
