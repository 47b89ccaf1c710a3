#include "ensonify/sim/voxelize.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <cmath>

#include "ensonify/core/error.hpp"
#include "ensonify/core/random.hpp"
#include "ensonify/sim/mesh_edges.hpp"
#include "ensonify/sim/voxel_parity.hpp"
#include "support/meshes.hpp"

namespace ensonify {
namespace {

using test::box_mesh;

/// Scene of meshes, each once at the origin.
Scene scene_of(const std::vector<TriangleMesh>& meshes, const Vec3& low, const Vec3& high) {
  Scene scene;
  scene.name = "test";
  scene.meshes = meshes;
  for (int i = 0; i < static_cast<int>(meshes.size()); ++i) {
    scene.instances.push_back({.name = "object " + std::to_string(i), .mesh = i});
  }
  scene.bounds_m = {low, high};
  return scene;
}

std::size_t count(const OccupancyGrid& grid, Occupancy value) {
  return static_cast<std::size_t>(
      std::count(grid.occupancy.begin(), grid.occupancy.end(), static_cast<std::uint8_t>(value)));
}

/// Share of the mesh's own volume that the cell centres inside of it make up.
double volume_ratio(const TriangleMesh& mesh, double resolution_m, const Vec3& shift_cells) {
  std::vector<Vec3> cells;
  Eigen::AlignedBox3d box;
  for (const auto& v : mesh.vertices_m) {
    cells.push_back(v.cast<double>() / resolution_m + shift_cells);
    box.extend(cells.back());
  }
  const std::array<int, 3> low = {static_cast<int>(std::floor(box.min().x())) - 1,
                                  static_cast<int>(std::floor(box.min().y())) - 1,
                                  static_cast<int>(std::floor(box.min().z())) - 1};
  std::array<int, 3> size{};
  for (int a = 0; a < 3; ++a) size[a] = static_cast<int>(std::ceil(box.max()[a])) + 1 - low[a];
  const ParityVote vote = vote_parity(cells, mesh.triangles, low, size);
  return static_cast<double>(vote.inside.count()) * std::pow(resolution_m, 3) / test::volume_m3(mesh);
}

TEST(Voxelize, SolidVolumeOfSphereAndTorusIsTheMeshesOwn) {
  EXPECT_NEAR(volume_ratio(test::sphere_mesh(1), 0.02, Vec3(0.13, 0.37, 0.71)), 1, 1e-3);
  EXPECT_NEAR(volume_ratio(test::sphere_mesh(1), 0.02, Vec3::Zero()), 1, 1e-3);
  EXPECT_NEAR(volume_ratio(test::torus_mesh(2, 1), 0.02, Vec3(0.13, 0.37, 0.71)), 1, 1e-3);
}

TEST(Voxelize, BoxBetweenCellBordersFillsItsOwnCellsAndNoWater) {
  const auto truth = voxelize(scene_of({box_mesh({-0.5, -0.5, -2.5}, {0.5, 0.5, -1.5})}, {-2, -2, -4}, {2, 2, 0}), 0.1);
  EXPECT_EQ(count(truth.grid, Occupancy::surface), 10u * 10 * 10 - 8 * 8 * 8);
  EXPECT_EQ(count(truth.grid, Occupancy::interior), 8u * 8 * 8);
  EXPECT_EQ(truth.reports[0].parity_disagreements, 0u);
  EXPECT_TRUE(truth.reports[0].watertight);
}

TEST(Voxelize, BoxWithFacesThroughCellCentresHasNoStripes) {
  const auto truth =
      voxelize(scene_of({box_mesh({-0.55F, -0.55F, -2.55F}, {0.55F, 0.55F, -1.45F})}, {-2, -2, -4}, {2, 2, 0}), 0.1);
  EXPECT_EQ(count(truth.grid, Occupancy::surface), 12u * 12 * 12 - 10 * 10 * 10);
  EXPECT_EQ(count(truth.grid, Occupancy::interior), 10u * 10 * 10);
  EXPECT_EQ(truth.reports[0].parity_disagreements, 0u);
}

TEST(Voxelize, ParityOfBoxOnCellCentresIsHalfOpenOnEveryAxis) {
  const TriangleMesh box = box_mesh({2.5, 3.5, 4.5}, {7.5, 9.5, 11.5});
  std::vector<Vec3> cells;
  for (const auto& v : box.vertices_m) cells.push_back(v.cast<double>());
  const ParityVote vote = vote_parity(cells, box.triangles, {0, 0, 0}, {16, 16, 16});
  EXPECT_EQ(vote.inside.count(), 5u * 6 * 7);
  EXPECT_EQ(vote.disagreement.count(), 0u);
  EXPECT_TRUE(vote.inside.test(2, 3, 4));
  EXPECT_FALSE(vote.inside.test(7, 3, 4));
}

TEST(Voxelize, FlippedTrianglesChangeNothing) {
  TriangleMesh mesh = test::torus_mesh(1, 0.4, 64, 32);
  const Scene scene = scene_of({mesh}, {-2, -2, -1}, {2, 2, 1});
  Scene flipped = scene;
  for (std::size_t i = 0; i < mesh.triangles.size(); i += 3) {
    std::swap(flipped.meshes[0].triangles[i][0], flipped.meshes[0].triangles[i][1]);
  }
  EXPECT_EQ(voxelize(scene, 0.05).grid.occupancy, voxelize(flipped, 0.05).grid.occupancy);
}

TEST(Voxelize, BoxWithoutLidIsAShellAndSaysSo) {
  const auto truth =
      voxelize(scene_of({test::open_box_mesh({-0.5, -0.5, -2.5}, {0.5, 0.5, -1.5})}, {-2, -2, -4}, {2, 2, 0}), 0.1);
  EXPECT_EQ(count(truth.grid, Occupancy::interior), 0u);
  EXPECT_EQ(truth.reports[0].open_edges, 4u);
  EXPECT_FALSE(truth.reports[0].watertight);
  EXPECT_EQ(truth.reports[0].method, SolidMethod::outside_fill);
  EXPECT_THAT(truth.reports[0].describe(), testing::HasSubstr("4 open edges"));
  EXPECT_EQ(truth.reports[0].surface_cells, 10u * 10 * 10 - 8 * 8 * 9);
}

TEST(Voxelize, HemisphereIsAShell) {
  const auto truth = voxelize(scene_of({test::hemisphere_mesh(1)}, {-2, -2, -2}, {2, 2, 2}), 0.05);
  EXPECT_EQ(count(truth.grid, Occupancy::interior), 0u);
  EXPECT_EQ(truth.reports[0].open_edges, 96u);
  EXPECT_GT(truth.reports[0].parity_disagreements, 0u);
}

TEST(Voxelize, ShellWithASlitNarrowerThanACellIsSolid) {
  TriangleMesh mesh = box_mesh({-0.5, -0.5, -0.5}, {0.5, 0.5, 0.5});
  for (auto& t : mesh.triangles) {  // every triangle on its own vertices, the top 1 mm off: open on all sides
    for (auto& v : t) {
      const bool top = &t - mesh.triangles.data() == 2 || &t - mesh.triangles.data() == 3;
      mesh.vertices_m.push_back(mesh.vertices_m[v] + (top ? Eigen::Vector3f(0, 0, 1e-3F) : Eigen::Vector3f::Zero()));
      v = static_cast<std::uint32_t>(mesh.vertices_m.size() - 1);
    }
  }
  const auto truth = voxelize(scene_of({mesh}, {-1, -1, -1}, {1, 1, 1}), 0.03);
  EXPECT_EQ(truth.reports[0].open_edges, 8u);
  EXPECT_GT(count(truth.grid, Occupancy::interior), 28000u);
}

TEST(Voxelize, OverlappingSolidsUnite) {
  const TriangleMesh a = box_mesh({-0.5, -0.5, -2.5}, {0.5, 0.5, -1.5});
  const TriangleMesh b = box_mesh({-0.1F, -0.1F, -2.1F}, {1.1F, 1.1F, -1.1F});
  const Vec3 low(-2, -2, -4);
  const Vec3 high(2, 2, 0);
  const auto both = voxelize(scene_of({a, b}, low, high), 0.1).grid.occupancy;
  const auto only_a = voxelize(scene_of({a}, low, high), 0.1).grid.occupancy;
  const auto only_b = voxelize(scene_of({b}, low, high), 0.1).grid.occupancy;
  EXPECT_EQ(both, voxelize(scene_of({b, a}, low, high), 0.1).grid.occupancy);
  for (std::size_t i = 0; i < both.size(); ++i) ASSERT_EQ(both[i], std::max(only_a[i], only_b[i]));
}

TEST(Voxelize, InstancesThatAreNoObstacleOccupyNothing) {
  Scene scene = scene_of({box_mesh({-0.5, -0.5, -2.5}, {0.5, 0.5, -1.5})}, {-2, -2, -4}, {2, 2, 0});
  scene.instances[0].obstacle = false;
  const auto truth = voxelize(scene, 0.1);
  EXPECT_EQ(count(truth.grid, Occupancy::free), truth.grid.frame.cells());
  EXPECT_TRUE(truth.reports.empty());
}

TEST(Voxelize, ClippingAtTheBoundsDoesNotChangeTheCellsInside) {
  const TriangleMesh sphere = test::sphere_mesh(1);
  const auto whole = voxelize(scene_of({sphere}, {-2, -2, -2}, {2, 2, 2}), 0.05).grid;
  const auto part = voxelize(scene_of({sphere}, {-0.4, -0.3, -2}, {0.5, 0.2, 0}), 0.05).grid;
  for (int z = 0; z < part.frame.size[2]; ++z) {
    for (int y = 0; y < part.frame.size[1]; ++y) {
      for (int x = 0; x < part.frame.size[0]; ++x) {
        const auto [wx, wy, wz] = whole.frame.cell_of(part.frame.centre_m(x, y, z));
        ASSERT_EQ(part.occupancy[part.frame.index(x, y, z)], whole.occupancy[whole.frame.index(wx, wy, wz)]);
      }
    }
  }
}

TEST(Voxelize, SameBitsForAnyNumberOfThreads) {
  Scene scene =
      scene_of({test::torus_mesh(1, 0.4), test::sphere_mesh(0.7), test::hemisphere_mesh(0.5)}, {-2, -2, -1}, {2, 2, 1});
  scene.instances[1].T_world_object.translate(Vec3(0.6, 0.2, 0.1));
  std::vector<std::vector<std::uint8_t>> results;
  for (const std::size_t threads : {1, 2, 8}) {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
    results.push_back(voxelize(scene, 0.03).grid.occupancy);
  }
  EXPECT_EQ(results[0], results[1]);
  EXPECT_EQ(results[0], results[2]);
}

TEST(FrameOver, TopIsTheWaterSurfaceAndBordersAreMultiples) {
  const GridFrame frame = frame_over({Vec3(-1.02, -3, -4.31), Vec3(1, 2.99, 0)}, 0.1);
  EXPECT_NEAR(frame.origin_m.z() + frame.size[2] * 0.1, 0, 1e-12);
  EXPECT_NEAR(frame.origin_m.x(), -1.1, 1e-12);
  EXPECT_EQ(frame.size, (std::array<int, 3>{21, 60, 44}));
}

TEST(FrameOver, RefusesTooManyCellsAndNamesAResolutionThatFits) {
  const Eigen::AlignedBox3d bounds(Vec3(-50, -50, -20), Vec3(50, 50, 0));
  try {
    frame_over(bounds, 0.1);
    FAIL();
  } catch (const ConfigError& error) {
    EXPECT_THAT(error.what(), testing::HasSubstr("0.15 m fits"));
  }
  EXPECT_NO_THROW(frame_over(bounds, 0.15));
  EXPECT_NO_THROW(frame_over(bounds, 0.1, 200'000'000));
  EXPECT_THROW(frame_over(bounds, 0), ConfigError);
  EXPECT_THROW(frame_over(bounds, std::nan("")), ConfigError);
  EXPECT_THROW(frame_over({Vec3(0, 0, 0), Vec3(0, 1, 1)}, 0.1), ConfigError);
}

TEST(Voxelize, BrokenMeshesAreRefused) {
  TriangleMesh mesh = box_mesh({-0.5, -0.5, -0.5}, {0.5, 0.5, 0.5});
  mesh.triangles[3][1] = 8;
  EXPECT_THROW(voxelize(scene_of({mesh}, {-1, -1, -1}, {1, 1, 1}), 0.1), DataError);
  mesh.triangles[3][1] = 0;
  mesh.vertices_m[2].y() = std::nanf("");
  EXPECT_THROW(voxelize(scene_of({mesh}, {-1, -1, -1}, {1, 1, 1}), 0.1), DataError);
}

// A cube on borders of cells, which its faces' sides decide: 8 x 8 x 8 cells inside of a shell that is one cell thick.
TEST(Voxelize, MeshesTurnedInsideOutHaveTheSameTruth) {
  const TriangleMesh outward = box_mesh({-0.5, -0.5, -0.5}, {0.5, 0.5, 0.5});
  TriangleMesh inward = outward;
  for (auto& t : inward.triangles) std::swap(t[1], t[2]);
  const auto voxels = [](const TriangleMesh& mesh) { return voxelize(scene_of({mesh}, {-1, -1, -1}, {1, 1, 1}), 0.1); };
  EXPECT_EQ(voxels(inward).grid.occupancy, voxels(outward).grid.occupancy);
  EXPECT_EQ(voxels(outward).reports[0].surface_cells, 1000u - 512u);
  EXPECT_FALSE(voxels(outward).reports[0].inside_out);
  EXPECT_TRUE(voxels(inward).reports[0].inside_out);

  TriangleMesh half = outward;
  std::swap(half.triangles[0][1], half.triangles[0][2]);
  EXPECT_TRUE(voxels(half).reports[0].watertight);
  EXPECT_EQ(voxels(half).reports[0].unlike_edges, 3u);
  EXPECT_THAT(voxels(half).reports[0].describe(), testing::HasSubstr("turned differently"));

  // A mirror turns every face over, and the placed object is what counts.
  Scene mirrored = scene_of({outward}, {-1, -1, -1}, {1, 1, 1});
  mirrored.instances[0].T_world_object = Eigen::Affine3d(Eigen::Scaling(-1.0, 1.0, 1.0));
  EXPECT_EQ(voxelize(mirrored, 0.1).grid.occupancy, voxels(outward).grid.occupancy);
}

TEST(MeshEdges, RepeatedVerticesCountAsOne) {
  TriangleMesh mesh = box_mesh({0, 0, 0}, {1, 1, 1});
  for (auto& t : mesh.triangles) {
    for (auto& v : t) {
      mesh.vertices_m.push_back(mesh.vertices_m[v]);
      v = static_cast<std::uint32_t>(mesh.vertices_m.size() - 1);
    }
  }
  EXPECT_TRUE(count_edges(mesh).watertight());
  mesh.triangles.push_back(mesh.triangles.front());
  EXPECT_EQ(count_edges(mesh).nonmanifold, 3u);
  EXPECT_EQ(count_edges({}).open, 0u);
}

}  // namespace
}  // namespace ensonify
