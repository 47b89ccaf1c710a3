#include "ensonify/output/grid_octomap.hpp"

#include <fmt/format.h>
#include <octomap/OcTree.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <sstream>
#include <vector>

#include "ensonify/core/error.hpp"
#include "ensonify/core/parallel.hpp"
#include "ensonify/output/atomic_file.hpp"

namespace ensonify {
namespace {

constexpr int tree_depth = 16;

/// Bits, so that the state of a block is the union of the states of its parts.
enum State : std::uint8_t { unknown = 1, free_space = 2, occupied = 4 };

/// Blocks of 2^level cells a side, aligned as the tree's nodes are.
struct Level {
  std::array<int, 3> low{};  ///< key of the first block, shifted by the level
  std::array<int, 3> size{};
  std::vector<std::uint8_t> state;

  std::uint8_t at(int x, int y, int z) const {
    x -= low[0];
    y -= low[1];
    z -= low[2];
    if (x < 0 || y < 0 || z < 0 || x >= size[0] || y >= size[1] || z >= size[2]) return unknown;
    return state[(static_cast<std::size_t>(z) * size[1] + y) * size[0] + x];
  }
};

std::array<int, 3> low_key(const GridFrame& frame) {
  std::array<int, 3> low{};
  for (int a = 0; a < 3; ++a) {
    const double cells = frame.origin_m[a] / frame.resolution_m;
    if (std::abs(cells - std::round(cells)) > 1e-3) {
      throw ConfigError(
          fmt::format("grid origin {} m is not a multiple of its resolution {} m, as OctoMap (.bt, .ot) needs; "
                      "voxelise it anew or write .npz",
                      frame.origin_m[a], frame.resolution_m));
    }
    const double first = std::round(cells) + (1 << (tree_depth - 1));
    if (first < 0 || first + frame.size[a] > (1 << tree_depth)) {
      throw ConfigError(
          fmt::format("grid reaches beyond the {} cells around 0 that OctoMap (.bt, .ot) can address; use a "
                      "coarser resolution or move the scene towards the origin",
                      1 << tree_depth));
    }
    low[a] = static_cast<int>(first);
  }
  return low;
}

Level finest_level(const OccupancyGrid& grid, bool unobserved_is_unknown) {
  Level level{low_key(grid.frame), grid.frame.size, std::vector<std::uint8_t>(grid.frame.cells())};
  for (std::size_t i = 0; i < level.state.size(); ++i) {
    level.state[i] = grid.occupancy[i] == static_cast<std::uint8_t>(Occupancy::free) ? free_space : occupied;
    if (unobserved_is_unknown && (grid.observable.empty() || !grid.observable[i])) level.state[i] = unknown;
  }
  return level;
}

Level coarser(const Level& fine) {
  Level coarse;
  for (int a = 0; a < 3; ++a) {
    coarse.low[a] = fine.low[a] >> 1;
    coarse.size[a] = ((fine.low[a] + fine.size[a] - 1) >> 1) - coarse.low[a] + 1;
  }
  coarse.state.assign(static_cast<std::size_t>(coarse.size[0]) * coarse.size[1] * coarse.size[2], 0);
  parallel_for(coarse.size[2], [&](int slab) {
    std::size_t out = static_cast<std::size_t>(slab) * coarse.size[1] * coarse.size[0];
    const int z = 2 * (coarse.low[2] + slab);
    for (int y = 2 * coarse.low[1]; y < 2 * (coarse.low[1] + coarse.size[1]); y += 2) {
      for (int x = 2 * coarse.low[0]; x < 2 * (coarse.low[0] + coarse.size[0]); x += 2) {
        std::uint8_t all = 0;
        for (int i = 0; i < 8; ++i) all |= fine.at(x + (i & 1), y + ((i >> 1) & 1), z + (i >> 2));
        coarse.state[out++] = all;
      }
    }
  });
  return coarse;
}

/// OctoMap makes a root only by walking down to a leaf; this makes one bare.
struct Tree : octomap::OcTree {
  using octomap::OcTree::OcTree;
  octomap::OcTreeNode* make_root() {
    root = new octomap::OcTreeNode();
    ++tree_size;
    size_changed = true;
    return root;
  }
};

/// Fills `node`, whose block at `level` is of mixed state. Uniform blocks stay whole: the tree is pruned from the
/// start.
void fill(Tree& tree, octomap::OcTreeNode* node, const std::vector<Level>& levels, int level, int x, int y, int z) {
  for (unsigned i = 0; i < 8; ++i) {
    const int cx = 2 * x + static_cast<int>(i & 1);
    const int cy = 2 * y + static_cast<int>((i >> 1) & 1);
    const int cz = 2 * z + static_cast<int>(i >> 2);
    const std::uint8_t state = levels[level - 1].at(cx, cy, cz);
    if (state == unknown) continue;
    octomap::OcTreeNode* child = tree.createNodeChild(node, i);
    child->setLogOdds(state & occupied ? tree.getClampingThresMaxLog() : tree.getClampingThresMinLog());
    if (state != occupied && state != free_space) fill(tree, child, levels, level - 1, cx, cy, cz);
  }
}

/// As fill(), but down to single cells, which hold their log-odds; equal ones are pruned on the way up.
void fill_values(Tree& tree, octomap::OcTreeNode* node, const std::vector<Level>& levels, int level,
                 const std::array<int, 3>& block, const LogOddsMap& map) {
  for (unsigned i = 0; i < 8; ++i) {
    const std::array<int, 3> c{2 * block[0] + static_cast<int>(i & 1), 2 * block[1] + static_cast<int>((i >> 1) & 1),
                               2 * block[2] + static_cast<int>(i >> 2)};
    if (levels[level - 1].at(c[0], c[1], c[2]) == unknown) continue;
    octomap::OcTreeNode* child = tree.createNodeChild(node, i);
    if (level == 1) {
      const auto& low = levels[0].low;
      child->setLogOdds(map.log_odds[map.frame.index(c[0] - low[0], c[1] - low[1], c[2] - low[2])]);
    } else {
      fill_values(tree, child, levels, level - 1, c, map);
    }
  }
  if (!tree.pruneNode(node)) node->updateOccupancyChildren();
}

std::vector<Level> levels_of(Level finest) {
  std::vector<Level> levels = {std::move(finest)};
  while (levels.size() <= tree_depth) levels.push_back(coarser(levels.back()));
  return levels;
}

/// The header that OcTree's own writers put; they print to standard error.
std::string header(const Tree& tree, const char* first_line) {
  return fmt::format(
      "{}\n# (feel free to add / change comments, but leave the first line as it is!)\n#\nid {}\nsize {}\nres {}\n"
      "data\n",
      first_line, tree.getTreeType(), tree.size(), tree.getResolution());
}

}  // namespace

void write_grid_octomap(const OccupancyGrid& grid, const std::filesystem::path& path, bool unobserved_is_unknown) {
  const std::vector<Level> levels = levels_of(finest_level(grid, unobserved_is_unknown));
  Tree tree(grid.frame.resolution_m);
  if (levels.back().at(0, 0, 0) != unknown) fill(tree, tree.make_root(), levels, tree_depth, 0, 0, 0);
  std::ostringstream bytes;
  bytes << header(tree, "# Octomap OcTree binary file");
  if (tree.size() > 0) tree.writeBinaryData(bytes);
  write_file(path, bytes.view());
}

void write_map_octomap(const LogOddsMap& map, const std::filesystem::path& path) {
  const std::vector<Level> levels = levels_of(finest_level(occupancy_of(map), true));
  Tree tree(map.frame.resolution_m);
  if (levels.back().at(0, 0, 0) != unknown) {
    fill_values(tree, tree.make_root(), levels, tree_depth, {0, 0, 0}, map);
  }
  std::ostringstream bytes;
  bytes << header(tree, "# Octomap OcTree file");
  if (tree.size() > 0) tree.writeData(bytes);
  write_file(path, bytes.view());
}

}  // namespace ensonify
