#include <benchmark/benchmark.h>
#include <tbb/global_control.h>

#include <chrono>
#include <cmath>

#include "ensonify/sim/voxelize.hpp"
#include "support/meshes.hpp"

#ifdef ENSONIFY_HAS_OPENVDB
#include <openvdb/openvdb.h>
#include <openvdb/tools/MeshToVolume.h>
#endif

namespace {

using namespace ensonify;

/// Closed bumpy sphere, radius 5 m, 99 224 triangles.
TriangleMesh bumpy_sphere() {
  return test::bumpy_sphere_mesh(5, 316, 158, [](double longitude, double latitude) {
    return 1 + 0.04 * std::sin(7 * longitude) * std::cos(latitude) * std::cos(5 * latitude);
  });
}

/// Seconds of OpenVDB's signed distance field (half width 3) of the mesh on the same threads; NaN without OpenVDB.
double openvdb_s([[maybe_unused]] const TriangleMesh& mesh, [[maybe_unused]] double resolution_m) {
#ifdef ENSONIFY_HAS_OPENVDB
  openvdb::initialize();
  const auto transform = openvdb::math::Transform::createLinearTransform(resolution_m);
  std::vector<openvdb::Vec3s> points;
  for (const auto& v : mesh.vertices_m) points.emplace_back(v.x(), v.y(), v.z());
  std::vector<openvdb::Vec3I> triangles;
  for (const auto& t : mesh.triangles) triangles.emplace_back(t[0], t[1], t[2]);
  const auto begin = std::chrono::steady_clock::now();
  const auto grid = openvdb::tools::meshToLevelSet<openvdb::FloatGrid>(*transform, points, triangles, 3.0F);
  benchmark::DoNotOptimize(grid->activeVoxelCount());
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
#else
  return std::nan("");
#endif
}

/// Mesh to surface and solid occupancy; argument: threads. vs_openvdb = OpenVDB's time over ours.
void voxelize_bumpy_sphere(benchmark::State& state) {
  const tbb::global_control threads(tbb::global_control::max_allowed_parallelism,
                                    static_cast<std::size_t>(state.range(0)));
  Scene scene;
  scene.meshes = {bumpy_sphere()};
  scene.instances = {{.name = "bumpy sphere"}};
  scene.bounds_m = {Vec3(-5.6, -5.6, -5.6), Vec3(5.6, 5.6, 5.6)};
  double total_s = 0;
  VoxelReport report;
  for (auto _ : state) {
    const auto begin = std::chrono::steady_clock::now();
    const VoxelTruth truth = voxelize(scene, 0.05);
    total_s += std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    report = truth.reports[0];
  }
  state.counters["triangles"] = static_cast<double>(report.triangles);
  state.counters["surface"] = static_cast<double>(report.surface_cells);
  state.counters["interior"] = static_cast<double>(report.interior_cells);
  state.counters["disagree"] = static_cast<double>(report.parity_disagreements);
  state.counters["openvdb_s"] = openvdb_s(scene.meshes[0], 0.05);
  state.counters["vs_openvdb"] = state.counters["openvdb_s"] * static_cast<double>(state.iterations()) / total_s;
}
BENCHMARK(voxelize_bumpy_sphere)->Arg(1)->Arg(2)->Unit(benchmark::kMillisecond)->UseRealTime();

}  // namespace

BENCHMARK_MAIN();
