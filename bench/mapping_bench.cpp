#include <benchmark/benchmark.h>
#include <octomap/OcTree.h>
#include <tbb/global_control.h>

#include <ctime>

#include "ensonify/core/random.hpp"
#include "ensonify/mapping/integrate_ping.hpp"
#include "ensonify/mapping/threshold_sweep.hpp"
#include "range_scans.hpp"

namespace {

using namespace ensonify;

constexpr const char* absent = "room.scn is absent; set ENSONIFY_SHARED to the folder that holds bench/";

/// Of processor time: both rivals run in one thread, and others may use the machine.
double seconds_of(const auto& work) {
  const std::clock_t begin = std::clock();
  work();
  return static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC;
}

const std::optional<bench::RangeScans>& room() {
  static const std::optional<bench::RangeScans> scans = bench::read_range_scans(bench::room_scans_path());
  return scans;
}

struct CellCounts {
  std::size_t occupied = 0;
  std::size_t free = 0;
};

/// Seconds that OctoMap's insertPointCloud takes for all scans, and what it found.
double octomap_s(bool lazy, bool discretize, CellCounts& counts) {
  std::vector<octomap::Pointcloud> clouds;
  for (const RangeScan& scan : room()->scans) {
    octomap::Pointcloud& cloud = clouds.emplace_back();
    for (const Vec3& p : scan.points_m) {
      cloud.push_back(static_cast<float>(p.x()), static_cast<float>(p.y()), static_cast<float>(p.z()));
    }
  }
  octomap::OcTree tree(static_cast<double>(room()->resolution_m));
  const double s = seconds_of([&] {
    for (std::size_t i = 0; i < clouds.size(); ++i) {
      const Eigen::Vector3f o = room()->scans[i].origin_m.cast<float>();
      tree.insertPointCloud(clouds[i], {o.x(), o.y(), o.z()}, static_cast<double>(room()->max_range_m), lazy,
                            discretize);
    }
    if (lazy) tree.updateInnerOccupancy();
  });
  tree.expand();
  for (auto leaf = tree.begin_leafs(); leaf != tree.end_leafs(); ++leaf) {
    ++(tree.isNodeOccupied(*leaf) ? counts.occupied : counts.free);
  }
  return s;
}

GridFrame room_frame() {
  Vec3 low = Vec3::Constant(1e9);
  Vec3 high = -low;
  for (const RangeScan& scan : room()->scans) {
    low = low.cwiseMin((scan.origin_m.array() - room()->max_range_m).matrix());
    high = high.cwiseMax((scan.origin_m.array() + room()->max_range_m).matrix());
  }
  GridFrame frame;
  frame.resolution_m = static_cast<double>(room()->resolution_m);
  for (int a = 0; a < 3; ++a) {
    frame.origin_m[a] = std::floor(low[a] / frame.resolution_m) * frame.resolution_m;
    frame.size[a] = static_cast<int>(std::ceil((high[a] - frame.origin_m[a]) / frame.resolution_m)) + 1;
  }
  return frame;
}

/// 100 scans of 512 x 64 rays into 5 cm cells, one thread, with OctoMap's log-odds. vs_octomap: the time of the mode of
/// OctoMap that does the same, over ours, in the same run. Arguments: line rule; does that mode defer its inner nodes.
void insert_room(benchmark::State& state) {
  if (!room()) return state.SkipWithError(absent);
  const tbb::global_control one_thread(tbb::global_control::max_allowed_parallelism, 1);
  const LineRule rule = state.range(0) == 0 ? LineRule::bresenham_once_an_end : LineRule::exact_every_ray;
  const ScanOptions options = {
      .rule = rule, .max_range_m = static_cast<double>(room()->max_range_m), .step = {.free = -405, .occupied = 847}};
  double best_s = 1e9;
  CellCounts ours;
  for (auto _ : state) {
    LogOddsGrid grid(room_frame(), {.lowest = -2000, .highest = 3511});
    ScanScratch scratch;
    best_s = std::min(best_s, seconds_of([&] {
                        for (const RangeScan& scan : room()->scans) insert_scan(scan, options, grid, scratch);
                      }));
    state.PauseTiming();
    ours = {};
    const Cell n = grid.frame().size;
    for (int z = 0; z < n[2]; ++z) {
      for (int y = 0; y < n[1]; ++y) {
        for (int x = 0; x < n[0]; ++x) {
          const MilliLogOdds v = grid.at({x, y, z});
          ours.occupied += v > 0;
          ours.free += v < 0;
        }
      }
    }
    state.counters["MB"] = static_cast<double>(grid.bytes()) / 1e6;
    state.ResumeTiming();
  }
  CellCounts theirs;
  const double theirs_s = octomap_s(state.range(1) != 0, rule == LineRule::bresenham_once_an_end, theirs);
  state.counters["rays_per_s"] = static_cast<double>(room()->rays) / best_s;
  state.counters["best_s"] = best_s;
  state.counters["octomap_s"] = theirs_s;
  state.counters["vs_octomap"] = theirs_s / best_s;
  state.counters["asked"] = rule == LineRule::bresenham_once_an_end ? 20 : 5;
  state.counters["occupied"] = static_cast<double>(ours.occupied);
  state.counters["free"] = static_cast<double>(ours.free);
  state.counters["octomap_occupied"] = static_cast<double>(theirs.occupied);
  state.counters["octomap_free"] = static_cast<double>(theirs.free);
}
BENCHMARK(insert_room)
    ->Args({0, 1})
    ->Args({1, 1})
    ->Args({1, 0})
    ->ArgNames({"exact", "lazy"})
    ->Unit(benchmark::kMillisecond)
    ->MeasureProcessCPUTime()
    ->UseRealTime();

/// A ping of a wall with speckle: 512 beams over 60 deg, 512 bins to 10 m, 12 deg of elevation, looking askew.
PosedImage wall_ping() {
  PosedImage ping;
  ping.geometry = {.range_min_m = 0.1,
                   .range_max_m = 10,
                   .range_bins = 512,
                   .beam_azimuth_rad = {},
                   .elevation_fov_rad = radians(12)};
  for (int b = 0; b < 512; ++b) {
    ping.geometry.beam_azimuth_rad.push_back(std::asin(std::sin(radians(30)) * (1 - 2.0 * b / 511)));
  }
  Image2<std::uint8_t> grey(512, 512);
  const RandomKey key = RandomKey::from_seed(1);
  for (int k = 0; k < 512; ++k) {
    for (int b = 0; b < 512; ++b) {
      const double wall_m = 7 / std::cos(ping.geometry.beam_azimuth_rad[static_cast<std::size_t>(b)]);
      const double mean = std::abs(ping.geometry.bin_centre_m(k) - wall_m) < 0.2 ? 120 : 12;
      const double u = uniform_at(key, static_cast<std::uint64_t>(512 * k + b));
      grey(k, b) = static_cast<std::uint8_t>(std::min(255.0, mean * std::sqrt(-std::log(u))));
    }
  }
  ping.grey = grey;
  ping.T_world_sonar = pose_from_xyz_rpy({0, 0, -3}, 0.02, 0.1, 0.7);
  return ping;
}

/// Pings into 5 cm cells; arguments: number of the model, threads. The column CPU is that of all threads.
void integrate_pings(benchmark::State& state) {
  const char* kinds[] = {"points", "arc", "arc_shadow", "carve"};
  const InverseModel model = inverse_model_named(kinds[state.range(0)]);
  const tbb::global_control threads(tbb::global_control::max_allowed_parallelism,
                                    static_cast<std::size_t>(state.range(1)));
  const PosedImage ping = wall_ping();
  LogOddsGrid grid({.origin_m = {-12, -12, -8}, .resolution_m = 0.05, .size = {480, 480, 160}});
  MarkBox<Mark> scratch;
  for (auto _ : state) integrate_ping(ping, 30, model, grid, scratch);
  state.SetLabel(kinds[state.range(0)]);
  state.counters["pings_per_s"] =
      benchmark::Counter(static_cast<double>(state.iterations()), benchmark::Counter::kIsRate);
}
BENCHMARK(integrate_pings)
    ->ArgsProduct({{0, 1, 2, 3}, {1, 2}})
    ->ArgNames({"model", "threads"})
    ->Unit(benchmark::kMillisecond)
    ->MeasureProcessCPUTime()
    ->UseRealTime();

/// 61 thresholds at once.
void sweep_pings(benchmark::State& state) {
  const tbb::global_control threads(tbb::global_control::max_allowed_parallelism, 2);
  const PosedImage ping = wall_ping();
  std::vector<double> thresholds(61);
  for (std::size_t t = 0; t < thresholds.size(); ++t) thresholds[t] = static_cast<double>(t);
  ThresholdSweep sweep({.origin_m = {-12, -12, -8}, .resolution_m = 0.05, .size = {480, 480, 160}}, thresholds, Arc{});
  for (auto _ : state) sweep.add(ping);
  state.counters["pings_per_s"] =
      benchmark::Counter(static_cast<double>(state.iterations()), benchmark::Counter::kIsRate);
  state.counters["MB"] = static_cast<double>(sweep.bytes()) / 1e6;
}
BENCHMARK(sweep_pings)->Unit(benchmark::kMillisecond)->MeasureProcessCPUTime()->UseRealTime();

}  // namespace

BENCHMARK_MAIN();
