#include <benchmark/benchmark.h>
#include <tbb/global_control.h>

#include <cmath>

#include "ensonify/sim/observe.hpp"

namespace {

using namespace ensonify;

/// One ping of 60 x 12 degrees to 5 m, 512 x 64 rays, a wall at 4 m, into a grid of 12 x 12 x 6 m; arguments: cell
/// (mm), threads.
void observe_ping(benchmark::State& state) {
  const tbb::global_control threads(tbb::global_control::max_allowed_parallelism,
                                    static_cast<std::size_t>(state.range(1)));
  SonarGeometry geometry;
  geometry.range_min_m = 0.1;
  geometry.range_max_m = 5;
  geometry.range_bins = 512;
  geometry.elevation_fov_rad = radians(12);
  PingTruth truth;
  for (int i = 0; i < 512; ++i) {
    const double azimuth = std::asin(std::sin(radians(30)) * (1 - 2 * (i + 0.5) / 512));
    geometry.beam_azimuth_rad.push_back(azimuth);
    truth.ray_azimuth_rad.push_back(static_cast<float>(azimuth));
  }
  truth.elevation_step_rad = static_cast<float>(radians(12) / 64);
  truth.lowest_elevation_rad.assign(512, static_cast<float>(radians(12) * (0.5 / 64 - 0.5)));
  truth.first_hit_range_m = Image2<float>(64, 512, 4.0F);
  OccupancyGrid grid;
  const double cell_m = 1e-3 * static_cast<double>(state.range(0));
  const int n = static_cast<int>(12 / cell_m);
  grid.frame = {.origin_m = Vec3(-6, -6, -6), .resolution_m = cell_m, .size = {n, n, n / 2}};
  grid.occupancy.assign(grid.frame.cells(), 0);
  const Pose pose = pose_from_xyz_rpy({-2, 0, -3}, 0.1, 0.3, 0.7);
  for (auto _ : state) mark_observed(truth, geometry, pose, grid);
  state.counters["observed"] =
      static_cast<double>(std::count(grid.observable.begin(), grid.observable.end(), std::uint8_t{1}));
}
BENCHMARK(observe_ping)->Args({100, 1})->Args({100, 2})->Args({50, 1})->Unit(benchmark::kMicrosecond)->UseRealTime();

}  // namespace

BENCHMARK_MAIN();
