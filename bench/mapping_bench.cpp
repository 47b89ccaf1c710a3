#include <benchmark/benchmark.h>
#include <octomap/OcTree.h>
#include <tbb/global_control.h>

#include <ctime>

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
    ->UseRealTime();

}  // namespace

BENCHMARK_MAIN();
