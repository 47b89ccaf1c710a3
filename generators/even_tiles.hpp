#pragma once

#include <vector>

#include "ensonify/generators/speckle_figures.hpp"

namespace ensonify {

constexpr int tile_rows = 64, tile_columns = 32;
constexpr double default_least_level = 20;
constexpr double most_even_variation = 0.1;
constexpr int most_even_tiles = 16;

struct Tile {
  Region region;
  double mean_level = 0;
  double variation = 0;  ///< standard deviation over mean of the means of its 16 x 16 pixels; 0 of an empty tile
};

/// All whole tiles of an image, row by row from its first pixel.
std::vector<Tile> all_tiles(const GreyImage& image);

/// Those of diffuse, even echo: mean level at least `least_level`, variation at most 0.1; the 16 that vary least, in
/// their order. Fully developed speckle without any texture has a variation of about 0.03 (gamma 0.5, two beams a
/// cell).
std::vector<Tile> even_tiles(const std::vector<Tile>& tiles, double least_level);

}  // namespace ensonify
