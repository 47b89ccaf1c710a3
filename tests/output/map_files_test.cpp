#include "ensonify/output/map_files.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <octomap/OcTree.h>

#include <cmath>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <memory>

#include "ensonify/core/error.hpp"
#include "ensonify/core/random.hpp"
#include "ensonify/output/atomic_file.hpp"
#include "ensonify/output/grid_files.hpp"
#include "ensonify/output/grid_npz.hpp"
#include "ensonify/output/npz.hpp"

namespace ensonify {
namespace {

namespace fs = std::filesystem;

class MapFiles : public testing::Test {
 protected:
  MapFiles() {
    std::string name = (fs::temp_directory_path() / "ensonify-XXXXXX").string();
    folder = ::mkdtemp(name.data());
  }
  ~MapFiles() override { fs::remove_all(folder); }

  fs::path folder;
};

/// No two axes alike: a free slab of equal values (which a tree prunes), unknown water, values beyond OctoMap's limits.
LogOddsMap example_map() {
  LogOddsMap map{{.origin_m = Vec3(-1.2, 0.4, -3.7), .resolution_m = 0.1, .size = {29, 17, 21}}, {}};
  map.log_odds.assign(map.frame.cells(), 0);
  const RandomKey key = RandomKey::from_seed(11);
  for (int z = 0; z < map.frame.size[2]; ++z) {
    for (int y = 0; y < map.frame.size[1]; ++y) {
      for (int x = 0; x < map.frame.size[0]; ++x) {
        const std::size_t i = map.frame.index(x, y, z);
        if (x < 18) map.log_odds[i] = -0.201F;
        if (x > 24) map.log_odds[i] = static_cast<float>(80 * (uniform_at(key, i) - 0.5));
        if (y == 16) map.log_odds[i] = 294.4F;
      }
    }
  }
  return map;
}

TEST_F(MapFiles, NpzReadsBackAndIsAnOccupancyGridToo) {
  const LogOddsMap map = example_map();
  write_map(map, folder / "map.npz");
  const LogOddsMap back = read_map(folder / "map.npz");
  EXPECT_EQ(back.log_odds, map.log_odds);
  EXPECT_EQ(back.frame.size, map.frame.size);
  EXPECT_EQ(back.frame.origin_m, map.frame.origin_m);
  EXPECT_EQ(back.frame.resolution_m, map.frame.resolution_m);
  const OccupancyGrid grid = read_grid(folder / "map.npz");
  EXPECT_EQ(grid.occupancy, occupancy_of(map).occupancy);
  EXPECT_EQ(grid.observable, occupancy_of(map).observable);
}

TEST_F(MapFiles, NumpyReadsTheNpz) {
  if (std::system("/usr/bin/python3 -c 'import numpy' 2>/dev/null") != 0) GTEST_SKIP() << "python3-numpy is absent";
  write_map(example_map(), folder / "map.npz");
  std::ofstream(folder / "check.py") << R"(
import numpy as np, sys
d = np.load(sys.argv[1] + '/map.npz', allow_pickle=False)
L = d['log_odds']
assert L.shape == (21, 17, 29) and L.dtype == np.float32
assert (d['occupancy'] == (L > 0)).all() and (d['observable'] == (L != 0)).all()
assert abs(L[3, 16, 2] - 294.4) < 1e-4 and abs(L[3, 2, 5] + .201) < 1e-6 and L[3, 2, 20] == 0
assert d['origin'].tolist() == [-1.2, .4, -3.7] and float(d['resolution']) == .1 and str(d['axis_order']) == 'z,y,x'
assert 'positive occupied' in str(d['log_odds_sign'])
)";
  const std::string command = "/usr/bin/python3 " + (folder / "check.py").string() + " " + folder.string();
  EXPECT_EQ(std::system(command.c_str()), 0);
}

/// Every cell of a box one larger than the map against OctoMap's own search.
template <typename Check>
void for_each_node(const octomap::OcTree& tree, const LogOddsMap& map, const Check& check) {
  for (int z = -1; z <= map.frame.size[2]; ++z) {
    for (int y = -1; y <= map.frame.size[1]; ++y) {
      for (int x = -1; x <= map.frame.size[0]; ++x) {
        const Vec3 p = map.frame.centre_m(x, y, z);
        const bool inside = map.frame.contains(x, y, z);
        check(tree.search(p.x(), p.y(), p.z()), inside ? map.log_odds[map.frame.index(x, y, z)] : 0.0F);
      }
    }
  }
}

TEST_F(MapFiles, OctomapReadsTheBtWithFreeCellsAndWithoutUnknownOnes) {
  const LogOddsMap map = example_map();
  write_map(map, folder / "map.bt");
  octomap::OcTree tree(1.0);
  ASSERT_TRUE(tree.readBinary((folder / "map.bt").string()));
  EXPECT_DOUBLE_EQ(tree.getResolution(), 0.1);
  for_each_node(tree, map, [&](const octomap::OcTreeNode* node, float value) {
    ASSERT_EQ(node != nullptr, value != 0);
    if (node) {
      ASSERT_EQ(tree.isNodeOccupied(node), value > 0);
    }
  });
}

TEST_F(MapFiles, OctomapReadsTheOtWithItsLogOdds) {
  const LogOddsMap map = example_map();
  write_map(map, folder / "map.ot");
  const std::unique_ptr<octomap::AbstractOcTree> read(octomap::AbstractOcTree::read((folder / "map.ot").string()));
  auto* tree = dynamic_cast<octomap::OcTree*>(read.get());
  ASSERT_NE(tree, nullptr);
  EXPECT_DOUBLE_EQ(tree->getResolution(), 0.1);
  for_each_node(*tree, map, [&](const octomap::OcTreeNode* node, float value) {
    ASSERT_EQ(node != nullptr, value != 0);
    if (node) {
      ASSERT_EQ(node->getLogOdds(), value);
    }
  });
  const std::size_t nodes = tree->size();
  EXPECT_EQ(tree->calcNumNodes(), nodes);
  EXPECT_LT(nodes, map.frame.cells()) << "the slab of equal values is not pruned";
  octomap::OcTree inner(*tree);
  inner.updateInnerOccupancy();
  EXPECT_EQ(inner.getRoot()->getLogOdds(), tree->getRoot()->getLogOdds());
}

TEST_F(MapFiles, AMapOfUnknownCellsIsAnEmptyTree) {
  LogOddsMap map = example_map();
  map.log_odds.assign(map.log_odds.size(), 0);
  for (const char* name : {"map.bt", "map.ot"}) EXPECT_NO_THROW(write_map(map, folder / name));
  octomap::OcTree tree(1.0);
  ASSERT_TRUE(tree.readBinary((folder / "map.bt").string()));
  EXPECT_EQ(tree.size(), 0u);
}

TEST_F(MapFiles, PgmIsTheSliceAtADepthWithUnknownCells) {
  LogOddsMap map{{.origin_m = Vec3(-1, 2, -3), .resolution_m = 0.5, .size = {3, 2, 2}}, std::vector<float>(12, 0)};
  map.log_odds[map.frame.index(2, 1, 1)] = 2.9F;
  map.log_odds[map.frame.index(0, 0, 1)] = -0.2F;
  map.log_odds[map.frame.index(1, 0, 0)] = 2.9F;
  write_map(map, folder / "map.pgm", -2.2);
  const auto grey = [](std::initializer_list<int> values) { return std::string(values.begin(), values.end()); };
  EXPECT_EQ(read_text(folder / "map.pgm"), "P5\n3 2\n255\n" + grey({205, 205, 0, 254, 205, 205}));
  EXPECT_THAT(read_text(folder / "map.yaml"), testing::HasSubstr("origin: [-1, 2, 0]"));
  EXPECT_THROW(write_map(map, folder / "map.pgm", 1.0), ConfigError);
}

TEST_F(MapFiles, PlyHoldsTheOccupiedCellsWithTheirLogOdds) {
  LogOddsMap map{{.origin_m = Vec3(-1, 2, -3), .resolution_m = 0.5, .size = {3, 2, 2}}, std::vector<float>(12, -0.2F)};
  map.log_odds[map.frame.index(2, 1, 1)] = 5.5F;
  write_map(map, folder / "map.ply");
  const std::string bytes = read_text(folder / "map.ply");
  EXPECT_THAT(bytes, testing::HasSubstr("element vertex 1\n"));
  EXPECT_THAT(bytes, testing::HasSubstr("property float log_odds\n"));
  std::array<float, 4> point{};
  const std::size_t data = bytes.find("end_header\n") + 11;
  ASSERT_EQ(bytes.size() - data, sizeof point);
  std::memcpy(point.data(), bytes.data() + data, sizeof point);
  EXPECT_THAT(point, testing::ElementsAre(0.25F, 2.75F, -2.25F, 5.5F));
}

TEST_F(MapFiles, CutOrForeignFilesAreDataErrors) {
  write_map(example_map(), folder / "map.npz");
  const std::string bytes = read_text(folder / "map.npz");
  for (std::size_t part = 0; part < 40; ++part) {
    write_file(folder / "cut.npz", std::string_view(bytes).substr(0, bytes.size() * part / 40));
    EXPECT_THROW(read_map(folder / "cut.npz"), DataError) << part;
  }
  OccupancyGrid grid = occupancy_of(example_map());
  write_grid(grid, folder / "grid.npz");
  EXPECT_THROW(read_map(folder / "grid.npz"), DataError);  // no log_odds
  LogOddsMap map = example_map();
  map.log_odds[7] = std::nanf("");
  EXPECT_THROW(write_map(map, folder / "nan.npz"), DataError);
  EXPECT_FALSE(fs::exists(folder / "nan.npz"));
  for (const float value : {std::nanf(""), HUGE_VALF, -HUGE_VALF}) {
    map.log_odds[7] = value;
    write_map_npz(map, folder / "foreign.npz");
    EXPECT_THROW(read_map(folder / "foreign.npz"), DataError) << value;
  }
  EXPECT_THROW(read_map(folder / "map.bt"), ConfigError);
}

TEST_F(MapFiles, UnknownExtensionsAndFramesOffTheLatticeAreRefused) {
  LogOddsMap map = example_map();
  try {
    require_map_format("map.xyz");
    FAIL();
  } catch (const ConfigError& error) {
    EXPECT_THAT(error.what(), testing::HasSubstr(".npz, .bt, .ot, .pgm or .ply"));
  }
  EXPECT_THROW(write_map(map, folder / "map.vdb"), ConfigError);
  map.frame.origin_m.x() += 0.03;
  EXPECT_THROW(write_map(map, folder / "map.ot"), ConfigError);
  map.log_odds.pop_back();
  EXPECT_THROW(write_map(map, folder / "map.npz"), ConfigError);
  EXPECT_TRUE(fs::is_empty(folder));
}

}  // namespace
}  // namespace ensonify
