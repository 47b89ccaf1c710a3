#include <benchmark/benchmark.h>
#include <unistd.h>

#include <filesystem>

#include "ensonify/output/grid_files.hpp"
#include "ensonify/sim/voxelize.hpp"
#include "support/meshes.hpp"

namespace {

using namespace ensonify;

/// Writes a grid of 10.1 M cells that holds a sphere of 5 m at 0.05 m.
void write_grid_file(benchmark::State& state, const char* extension) {
  Scene scene;
  scene.meshes = {test::sphere_mesh(5, 256, 128)};
  scene.instances = {{.name = "sphere"}};
  scene.bounds_m = {Vec3(-5.4, -5.4, -5.4), Vec3(5.4, 5.4, 5.4)};
  const VoxelTruth truth = voxelize(scene, 0.05);
  const auto path =
      std::filesystem::temp_directory_path() / ("ensonify-bench-" + std::to_string(::getpid()) + extension);
  for (auto _ : state) write_grid(truth.grid, path);
  state.counters["cells"] = static_cast<double>(truth.grid.frame.cells());
  state.counters["bytes"] = static_cast<double>(std::filesystem::file_size(path));
  std::filesystem::remove(path);
}
BENCHMARK_CAPTURE(write_grid_file, npz, ".npz")->Unit(benchmark::kMillisecond)->UseRealTime();
BENCHMARK_CAPTURE(write_grid_file, bt, ".bt")->Unit(benchmark::kMillisecond)->UseRealTime();
BENCHMARK_CAPTURE(write_grid_file, ply, ".ply")->Unit(benchmark::kMillisecond)->UseRealTime();

}  // namespace

BENCHMARK_MAIN();
