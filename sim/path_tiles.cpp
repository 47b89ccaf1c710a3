#include "ensonify/sim/path_tiles.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace ensonify {
namespace {

constexpr int most_halvings = 6;

std::uint32_t reversed3(std::uint32_t q) { return ((q & 1) << 2) | (q & 2) | (q >> 2); }
float fraction(float x) { return x - std::floor(x); }

/// Integer hash with little bias (Wellons 2018, "lowbias32").
std::uint32_t hashed(std::uint32_t x) {
  x = (x ^ (x >> 16)) * 0x7feb352du;
  x = (x ^ (x >> 15)) * 0x846ca68bu;
  return x ^ (x >> 16);
}

float unit_at(std::uint32_t address, std::uint32_t which) {
  return static_cast<float>(hashed(address * 8 + which) >> 8) * 0x1p-24f;
}

/// Every second bit of x.
int every_second(int x) {
  int out = 0;
  for (int bit = 0; bit < 15; ++bit) out |= (x >> (2 * bit) & 1) << bit;
  return out;
}

}  // namespace

int PathTiles::Grid::cell_of(float u, float v) const {
  const int c = std::clamp(static_cast<int>(u * static_cast<float>(columns)), 0, columns - 1);
  const int r = std::clamp(static_cast<int>(v * static_cast<float>(rows)), 0, rows - 1);
  return r * columns + c;
}

PathTiles::PathTiles(const Grid& grid, std::vector<int> halvings) : grid_(grid), halvings_(std::move(halvings)) {
  for (int k = 0; k < grid_.cells(); ++k) {
    const int square = k / (grid_.rows * grid_.rows);
    const int within = k % (grid_.rows * grid_.rows);
    const int c = square * grid_.rows + every_second(within);
    const int r = every_second(within >> 1);
    const int cell = r * grid_.columns + c;
    const float w = width(cell);
    const float h = height(cell);
    const int across = 1 << (halvings_[cell] / 2);
    const int upwards = 1 << ((halvings_[cell] + 1) / 2);
    for (int i = 0; i < across; ++i) {
      for (int j = 0; j < upwards; ++j) {
        const auto address = static_cast<std::uint32_t>((cell * 128 + across * upwards) * 64 + i * upwards + j);
        tiles_.push_back({cell, static_cast<float>(c) / static_cast<float>(grid_.columns) + static_cast<float>(i) * w,
                          static_cast<float>(r) / static_cast<float>(grid_.rows) + static_cast<float>(j) * h, w, h,
                          hashed(address)});
      }
    }
  }
}

PathTiles PathTiles::for_energy(const Grid& grid, const std::vector<float>& energy, int budget) {
  std::vector<float> weight(energy.size());
  float sum = 0.0f;
  for (int r = 0; r < grid.rows; ++r) {
    for (int c = 0; c < grid.columns; ++c) {
      float around = 0.0f;  // a few walks miss what their neighbours find
      for (int i = std::max(r - 1, 0); i <= std::min(r + 1, grid.rows - 1); ++i) {
        for (int j = std::max(c - 1, 0); j <= std::min(c + 1, grid.columns - 1); ++j) {
          around += (i == r && j == c ? 1.0f : 0.25f) * energy[i * grid.columns + j];
        }
      }
      sum += weight[r * grid.columns + c] = std::sqrt(around);
    }
  }
  const float spare = static_cast<float>(std::max(0, budget - grid.cells()));
  std::vector<int> halvings(energy.size(), 0);
  for (std::size_t i = 0; i < energy.size() && sum > 0.0f; ++i) {
    const float wanted = 1.0f + spare * weight[i] / sum;
    while (halvings[i] < most_halvings && static_cast<float>(2 << halvings[i]) < 1.5f * wanted) ++halvings[i];
  }
  return PathTiles(grid, std::move(halvings));
}

PathTiles::Point PathTiles::point(const Tile& tile, int q) const {
  const auto k = static_cast<float>(q);
  const std::uint32_t shift = hashed(tile.address) & 7;
  // Steps of the two- and three-dimensional golden ratio (Roberts 2018).
  const float x = (k + fraction(unit_at(tile.address, 0) + k * 0.75487767f)) / points;
  const float y = (static_cast<float>(reversed3(static_cast<std::uint32_t>(q)) ^ shift) +
                   fraction(unit_at(tile.address, 1) + k * 0.56984029f)) /
                  points;
  return {tile.u + tile.width * x, tile.v + tile.height * y, fraction(unit_at(tile.address, 2) + k * 0.8191725f),
          fraction(unit_at(tile.address, 3) + k * 0.6710436f), fraction(unit_at(tile.address, 4) + k * 0.5497005f)};
}

}  // namespace ensonify
