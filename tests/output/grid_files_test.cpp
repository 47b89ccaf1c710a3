#include "ensonify/output/grid_files.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <octomap/OcTree.h>
#include <sys/resource.h>
#include <unistd.h>

#include <csignal>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <sstream>

#ifdef ENSONIFY_HAS_OPENVDB
#include <openvdb/openvdb.h>
#endif

#include "ensonify/core/error.hpp"
#include "ensonify/core/random.hpp"
#include "ensonify/output/atomic_file.hpp"
#include "ensonify/output/npz.hpp"

namespace ensonify {
namespace {

namespace fs = std::filesystem;

/// A folder of its own for each test, gone with it.
class GridFiles : public testing::Test {
 protected:
  GridFiles() {
    std::string name = (fs::temp_directory_path() / "ensonify-XXXXXX").string();
    folder = ::mkdtemp(name.data());
  }
  ~GridFiles() override { fs::remove_all(folder); }

  std::size_t files() const {
    return static_cast<std::size_t>(std::distance(fs::directory_iterator(folder), fs::directory_iterator()));
  }

  fs::path folder;
};

/// No two axes alike, no symmetry: a ball of interior under a surface, blocks and single cells, half of it observed.
OccupancyGrid example_grid() {
  OccupancyGrid grid;
  grid.frame = {.origin_m = Vec3(-1.2, 0.4, -3.7), .resolution_m = 0.1, .size = {37, 23, 31}};
  grid.occupancy.assign(grid.frame.cells(), 0);
  grid.observable.assign(grid.frame.cells(), 0);
  const RandomKey key = RandomKey::from_seed(7);
  for (int z = 0; z < grid.frame.size[2]; ++z) {
    for (int y = 0; y < grid.frame.size[1]; ++y) {
      for (int x = 0; x < grid.frame.size[0]; ++x) {
        const std::size_t i = grid.frame.index(x, y, z);
        const double r = std::hypot(x - 12, y - 10, z - 14);
        if (r < 9) grid.occupancy[i] = r < 7 ? 2 : 1;
        if (uniform_at(key, i) < 0.002) grid.occupancy[i] = 1;
        if (x > 30 && y < 4) grid.occupancy[i] = 2;
        grid.observable[i] = grid.occupancy[i] != 2 && x + 2 * y > 20;
      }
    }
  }
  return grid;
}

std::string read_bytes(const fs::path& path) {
  std::ifstream in(path, std::ios::binary);
  std::ostringstream bytes;
  bytes << in.rdbuf();
  return bytes.str();
}

void expect_equal(const OccupancyGrid& a, const OccupancyGrid& b) {
  EXPECT_EQ(a.frame.origin_m, b.frame.origin_m);
  EXPECT_EQ(a.frame.resolution_m, b.frame.resolution_m);
  EXPECT_EQ(a.frame.size, b.frame.size);
  EXPECT_EQ(a.occupancy, b.occupancy);
  EXPECT_EQ(a.observable, b.observable);
}

TEST_F(GridFiles, NpzReadsBackAndNothingElseIsLeft) {
  const OccupancyGrid grid = example_grid();
  write_grid(grid, folder / "grid.npz");
  expect_equal(read_grid(folder / "grid.npz"), grid);
  EXPECT_EQ(files(), 1u);
}

TEST_F(GridFiles, NpzIsTheSameBytesInEveryTimeZone) {
  ::setenv("TZ", "Pacific/Auckland", 1);
  ::tzset();
  write_grid(example_grid(), folder / "a.npz");
  ::setenv("TZ", "America/Anchorage", 1);
  ::tzset();
  write_grid(example_grid(), folder / "b.npz");
  ::unsetenv("TZ");
  ::tzset();
  EXPECT_EQ(read_bytes(folder / "a.npz"), read_bytes(folder / "b.npz"));
}

TEST_F(GridFiles, NumpyReadsTheNpz) {
  if (std::system("/usr/bin/python3 -c 'import numpy' 2>/dev/null") != 0) GTEST_SKIP() << "python3-numpy is absent";
  const OccupancyGrid grid = example_grid();
  write_grid(grid, folder / "grid.npz");
  std::ofstream(folder / "raw.bin", std::ios::binary)
      .write(reinterpret_cast<const char*>(grid.occupancy.data()), static_cast<long>(grid.occupancy.size()));
  std::ofstream(folder / "check.py") << R"(
import numpy as np, sys, zipfile
f = sys.argv[1]
assert zipfile.ZipFile(f + '/grid.npz').testzip() is None
d = np.load(f + '/grid.npz', allow_pickle=False)
assert d['occupancy'].shape == (31, 23, 37) and d['occupancy'].dtype == np.uint8
assert (d['occupancy'].ravel() == np.fromfile(f + '/raw.bin', np.uint8)).all()
assert d['observable'].shape == (31, 23, 37) and d['observable'].dtype == np.uint8 and d['observable'].max() == 1
assert d['origin'].dtype == np.float64 and d['origin'].tolist() == [-1.2, 0.4, -3.7]
assert d['resolution'].dtype == np.float64 and d['resolution'].shape == () and float(d['resolution']) == 0.1
assert str(d['axis_order']) == 'z,y,x'
)";
  const std::string command = "/usr/bin/python3 " + (folder / "check.py").string() + " " + folder.string();
  EXPECT_EQ(std::system(command.c_str()), 0);
}

TEST_F(GridFiles, NumpysOwnNpzReadsBack) {
  if (std::system("/usr/bin/python3 -c 'import numpy' 2>/dev/null") != 0) GTEST_SKIP() << "python3-numpy is absent";
  std::ofstream(folder / "make.py") << R"(
import numpy as np, sys
o = (np.arange(60) % 3).astype(np.uint8).reshape(3, 4, 5)
for save, name in ((np.savez, 'plain'), (np.savez_compressed, 'packed')):
    save(f'{sys.argv[1]}/{name}.npz', occupancy=o, origin=np.array([1., 2., 3.]), resolution=np.float64(0.5), note='x')
)";
  ASSERT_EQ(std::system(("/usr/bin/python3 " + (folder / "make.py").string() + " " + folder.string()).c_str()), 0);
  for (const char* name : {"plain.npz", "packed.npz"}) {
    const OccupancyGrid grid = read_grid(folder / name);
    EXPECT_EQ(grid.frame.size, (std::array<int, 3>{5, 4, 3}));
    EXPECT_EQ(grid.frame.origin_m, Vec3(1, 2, 3));
    EXPECT_EQ(grid.occupancy[grid.frame.index(2, 1, 0)], 7 % 3);
    EXPECT_TRUE(grid.observable.empty());
  }
}

TEST_F(GridFiles, TruncatedOrDamagedNpzIsADataError) {
  write_grid(example_grid(), folder / "grid.npz");
  const std::string bytes = read_bytes(folder / "grid.npz");
  for (std::size_t part = 0; part < 40; ++part) {
    write_file(folder / "cut.npz", std::string_view(bytes).substr(0, bytes.size() * part / 40));
    EXPECT_THROW(read_grid(folder / "cut.npz"), DataError) << part;
  }
  for (std::size_t i = 0; i < bytes.size(); i += 41) {  // never a crash; damage in a time stamp may pass
    std::string damaged = bytes;
    damaged[i] = static_cast<char>(damaged[i] ^ 0x55);
    write_file(folder / "damaged.npz", damaged);
    try {
      read_grid(folder / "damaged.npz");
    } catch (const DataError&) {
    }
  }
  EXPECT_THROW(read_grid(folder / "absent.npz"), DataError);
}

TEST_F(GridFiles, NpzThatUnpacksToTooMuchIsADataError) {
  write_npz(folder / "bomb.npz", {{"occupancy", {"|u1", {1000, 1000, 10}, std::string(10'000'000, '\0')}}});
  EXPECT_LT(fs::file_size(folder / "bomb.npz"), 100'000u);
  EXPECT_THROW(read_npz(folder / "bomb.npz", 1'000'000), DataError);
}

TEST_F(GridFiles, NpzOfWrongTypesOrShapesIsADataError) {
  const NpyArray cells{"|u1", {2, 2, 2}, std::string(8, '\1')};
  const NpyArray origin{"<f8", {3}, std::string(24, '\0')};
  const double half = 0.5;
  const NpyArray resolution{"<f8", {}, std::string(reinterpret_cast<const char*>(&half), 8)};
  const auto throws = [&](const std::map<std::string, NpyArray>& arrays) {
    write_npz(folder / "x.npz", arrays);
    EXPECT_THROW(read_grid(folder / "x.npz"), DataError);
  };
  throws({{"occupancy", cells}, {"origin", origin}});
  throws({{"occupancy", cells}, {"origin", origin}, {"resolution", {"<f8", {}, std::string(8, '\0')}}});
  throws({{"occupancy", cells}, {"origin", resolution}, {"resolution", resolution}});
  throws({{"occupancy", {"|u1", {2, 4}, cells.bytes}}, {"origin", origin}, {"resolution", resolution}});
  throws({{"occupancy", {"|u1", {2, 2, 2}, std::string(8, '\3')}}, {"origin", origin}, {"resolution", resolution}});
  throws({{"occupancy", {"|u1", {2, 2, 3}, cells.bytes}}, {"origin", origin}, {"resolution", resolution}});
  throws({{"occupancy", {"<u8", {1, 1, 1}, cells.bytes}}, {"origin", origin}, {"resolution", resolution}});
  write_npz(folder / "x.npz", {{"occupancy", cells}, {"origin", origin}, {"resolution", resolution}});
  EXPECT_NO_THROW(read_grid(folder / "x.npz"));
}

void expect_octomap_agrees(const OccupancyGrid& grid, const fs::path& path, bool masked) {
  octomap::OcTree tree(1.0);
  ASSERT_TRUE(tree.readBinary(path.string()));
  EXPECT_DOUBLE_EQ(tree.getResolution(), grid.frame.resolution_m);
  for (int z = -1; z <= grid.frame.size[2]; ++z) {
    for (int y = -1; y <= grid.frame.size[1]; ++y) {
      for (int x = -1; x <= grid.frame.size[0]; ++x) {
        const Vec3 p = grid.frame.centre_m(x, y, z);
        const octomap::OcTreeNode* node = tree.search(p.x(), p.y(), p.z());
        const bool inside = grid.frame.contains(x, y, z);
        const std::size_t i = inside ? grid.frame.index(x, y, z) : 0;
        const bool known = inside && (!masked || grid.observable[i]);
        ASSERT_EQ(node != nullptr, known);
        if (known) {
          ASSERT_EQ(tree.isNodeOccupied(node), grid.occupancy[i] != 0);
        }
      }
    }
  }
  const std::size_t nodes = tree.size();
  tree.prune();
  EXPECT_EQ(tree.size(), nodes) << "not pruned";
  EXPECT_EQ(tree.calcNumNodes(), nodes);
}

TEST_F(GridFiles, OctomapReadsTheBtAndEveryCellAgrees) {
  const OccupancyGrid grid = example_grid();
  write_grid(grid, folder / "grid.bt");
  expect_octomap_agrees(grid, folder / "grid.bt", false);
  write_grid(grid, folder / "seen.bt", {.unobserved_is_unknown = true});
  expect_octomap_agrees(grid, folder / "seen.bt", true);
}

TEST_F(GridFiles, BtRefusesGridsOffTheLattice) {
  OccupancyGrid grid = example_grid();
  grid.frame.origin_m.x() += 0.03;
  EXPECT_THROW(write_grid(grid, folder / "grid.bt"), ConfigError);
  grid.frame.origin_m.x() = 40'000;
  EXPECT_THROW(write_grid(grid, folder / "grid.bt"), ConfigError);
  EXPECT_EQ(files(), 0u);
}

TEST_F(GridFiles, PgmHasRowZeroAtTheLargestY) {
  OccupancyGrid grid;
  grid.frame = {.origin_m = Vec3(-1, 2, -3), .resolution_m = 0.5, .size = {3, 2, 2}};
  grid.occupancy.assign(12, 0);
  grid.observable.assign(12, 1);
  grid.occupancy[grid.frame.index(2, 1, 1)] = 1;
  grid.occupancy[grid.frame.index(0, 0, 0)] = 1;
  grid.observable[grid.frame.index(0, 0, 1)] = 0;
  write_grid(grid, folder / "map.pgm", {.slice_z_m = -2.2, .unobserved_is_unknown = true});
  const auto grey = [](std::initializer_list<int> values) { return std::string(values.begin(), values.end()); };
  EXPECT_EQ(read_bytes(folder / "map.pgm"), "P5\n3 2\n255\n" + grey({254, 254, 0, 205, 254, 254}));
  EXPECT_EQ(read_bytes(folder / "map.yaml"),
            "image: \"map.pgm\"\nmode: trinary\nresolution: 0.5\norigin: [-1, 2, 0]\nnegate: 0\n"
            "occupied_thresh: 0.65\nfree_thresh: 0.196\n");
  write_grid(grid, folder / "map.pgm", {.slice_z_m = -2.8});
  EXPECT_EQ(read_bytes(folder / "map.pgm"), "P5\n3 2\n255\n" + grey({254, 254, 254, 0, 254, 254}));
  EXPECT_THROW(write_grid(grid, folder / "map.pgm", {.slice_z_m = -1.9}), ConfigError);
}

TEST_F(GridFiles, PlyHoldsTheSurfaceCells) {
  const OccupancyGrid grid = example_grid();
  write_grid(grid, folder / "grid.ply");
  const std::string bytes = read_bytes(folder / "grid.ply");
  const auto surface = static_cast<std::size_t>(std::count(grid.occupancy.begin(), grid.occupancy.end(), 1));
  EXPECT_THAT(bytes, testing::HasSubstr("element vertex " + std::to_string(surface) + "\n"));
  const std::size_t data = bytes.find("end_header\n") + 11;
  ASSERT_EQ(bytes.size() - data, surface * 14);
  const auto first =
      static_cast<std::size_t>(std::find(grid.occupancy.begin(), grid.occupancy.end(), 1) - grid.occupancy.begin());
  float x = 0;
  std::memcpy(&x, bytes.data() + data, 4);
  EXPECT_FLOAT_EQ(x, static_cast<float>(-1.2 + 0.1 * (0.5 + static_cast<double>(first % 37))));
}

TEST_F(GridFiles, VdbReadsBackOrSaysWhatToInstall) {
  const OccupancyGrid grid = example_grid();
#ifdef ENSONIFY_HAS_OPENVDB
  write_grid(grid, folder / "grid.vdb");
  openvdb::initialize();
  openvdb::io::File file((folder / "grid.vdb").string());
  file.open();
  const auto vdb = openvdb::gridPtrCast<openvdb::FloatGrid>(file.readGrid("occupancy"));
  for (int z = 0; z < grid.frame.size[2]; ++z) {
    for (int y = 0; y < grid.frame.size[1]; ++y) {
      for (int x = 0; x < grid.frame.size[0]; ++x) {
        ASSERT_EQ(vdb->tree().getValue({x, y, z}), grid.occupancy[grid.frame.index(x, y, z)]);
      }
    }
  }
  const openvdb::Vec3d centre = vdb->indexToWorld(openvdb::Coord(3, 4, 5));
  const Vec3 expected = grid.frame.centre_m(3, 4, 5);
  EXPECT_NEAR((expected - Vec3(centre.x(), centre.y(), centre.z())).norm(), 0, 1e-9);
#else
  EXPECT_THROW(write_grid(grid, folder / "grid.vdb"), DataError);
#endif
}

TEST_F(GridFiles, UnknownExtensionNamesTheValidOnes) {
  try {
    write_grid(example_grid(), folder / "grid.xyz");
    FAIL();
  } catch (const ConfigError& error) {
    EXPECT_THAT(error.what(), testing::HasSubstr(".npz, .bt, .pgm, .ply or .vdb"));
  }
}

TEST_F(GridFiles, FailureLeavesTheOldFileAndNoTemporary) {
  write_file(folder / "old.txt", "old");
  const auto break_off = [](const fs::path& temporary) {
    write_file(temporary, "half of the ne");
    throw DataError("broken off");
  };
  EXPECT_THROW(write_atomically(folder / "old.txt", break_off), DataError);
  EXPECT_EQ(read_bytes(folder / "old.txt"), "old");
  EXPECT_EQ(files(), 1u);
  EXPECT_THROW(write_file(folder / "old.txt" / "below.txt", "x"), DataError);  // its folder is a file
  fs::create_directory(folder / "taken");
  EXPECT_THROW(write_file(folder / "taken", "x"), DataError);
  EXPECT_EQ(files(), 2u);
}

TEST_F(GridFiles, FullDiskIsADataErrorAndLeavesNothing) {
  rlimit before{};
  ::getrlimit(RLIMIT_FSIZE, &before);
  const rlimit small{.rlim_cur = 500, .rlim_max = before.rlim_max};  // stands in for the full disk
  const auto handler = std::signal(SIGXFSZ, SIG_IGN);
  ::setrlimit(RLIMIT_FSIZE, &small);
  std::string message;
  for (const char* name : {"grid.npz", "grid.bt", "grid.ply", "grid.pgm"}) {
    try {
      write_grid(example_grid(), folder / name);
    } catch (const DataError& error) {
      message = error.what();
    }
    EXPECT_THAT(message, testing::HasSubstr((folder / name).string()));
  }
  ::setrlimit(RLIMIT_FSIZE, &before);
  std::signal(SIGXFSZ, handler);
  EXPECT_EQ(files(), 0u);
}

}  // namespace
}  // namespace ensonify
