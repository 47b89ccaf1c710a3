/// Speed of a ping against its limit: the bare Embree cast of the same rays in the same run. Counters:
///   ratio_to_bare  time of PingTracer::trace over the time of casting its rays alone (asked: at most 2.5)
///   ping_ms        core time of a whole ping with the stages of a profile (asked: at most 35 with oculus_tank)
///   multipath_ms   time of MultipathTracer::trace, order 2, 512 x 512 (asked: at most 12 in pier_harbor)
///   pings_per_s    pose to image in memory, frames on all cores (asked: at least 200 on 2 cores)
#include <benchmark/benchmark.h>
#include <embree3/rtcore.h>
#include <tbb/global_control.h>

#include <chrono>

#include "ensonify/core/memory.hpp"
#include "ensonify/core/parallel.hpp"
#include "ensonify/generators/form_images.hpp"
#include "ensonify/generators/trajectory.hpp"
#include "ensonify/sim/flush_denormals.hpp"
#include "ensonify/sim/trace_ping.hpp"

namespace {

using namespace ensonify;

constexpr int poses_along_path = 64;

struct Setup {
  explicit Setup(const std::string& place)
      : scene(load_scene(place)),
        rays(scene),
        sonar(load_sonar("oculus_m1200d_hf")),
        tracer(rays, sonar, scene.water),
        multipath(rays, sonar, scene.water),
        receiver(sonar) {
    const Trajectory path(TrajectoryPoses{}, scene, RandomKey{});
    for (int i = 0; i < poses_along_path; ++i) poses.push_back(path.at(0.5 * path.repeats_s() * i / poses_along_path));
    SampledValues sampled;
    settings.noise = sample_noise(load_noise("paper"), RandomKey{}, sampled);
  }

  PingSetting setting(const Pose& T_world_sonar) const {
    return {.T_world_sonar = T_world_sonar,
            .absorption_db_per_m = absorption_db_per_m(scene.water, sonar.frequency_hz)};
  }

  Scene scene;
  RayScene rays;
  SonarModel sonar;
  PingTracer tracer;
  MultipathTracer multipath;
  Receiver receiver;
  ImageSettings settings;
  std::vector<Pose> poses;
};

/// Casts the rays of the fan and nothing else: directions made on the fly, hits summed so that they are not dropped.
float bare_cast(const Setup& setup, const Pose& T_world_sonar) {
  const FlushDenormals flush;
  const RayFan& fan = setup.tracer.fan();
  const Eigen::Matrix3f R = T_world_sonar.linear().cast<float>();
  const Eigen::Vector3f origin = T_world_sonar.translation().cast<float>();
  const auto reach_m = static_cast<float>(1.2 * setup.sonar.geometry.range_max_m);
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
  alignas(32) const int valid[8] = {-1, -1, -1, -1, -1, -1, -1, -1};
  float sum = 0.0f;
  for (std::size_t c = 0; c < fan.columns.size(); ++c) {
    const RayFan::Rows& rows = fan.rows_of(static_cast<int>(c));
    const Eigen::Vector3f ahead = fan.columns[c].cosine * R.col(0) + fan.columns[c].sine * R.col(1);
    for (int first = 0; first < fan.elevation_rays; first += 8) {
      alignas(32) RTCRayHit8 hit;
      for (int l = 0; l < 8; ++l) {
        hit.ray.org_x[l] = origin.x();
        hit.ray.org_y[l] = origin.y();
        hit.ray.org_z[l] = origin.z();
        hit.ray.dir_x[l] = rows.cosine[first + l] * ahead.x() + rows.sine[first + l] * R(0, 2);
        hit.ray.dir_y[l] = rows.cosine[first + l] * ahead.y() + rows.sine[first + l] * R(1, 2);
        hit.ray.dir_z[l] = rows.cosine[first + l] * ahead.z() + rows.sine[first + l] * R(2, 2);
        hit.ray.tnear[l] = 0.0f;
        hit.ray.tfar[l] = reach_m;
        hit.ray.time[l] = 0.0f;
        hit.ray.mask[l] = ~0u;
        hit.ray.id[l] = 0;
        hit.ray.flags[l] = 0;
        hit.hit.geomID[l] = RTC_INVALID_GEOMETRY_ID;
        hit.hit.instID[0][l] = RTC_INVALID_GEOMETRY_ID;
      }
      rtcIntersect8(valid, setup.rays.handle(), &context, &hit);
      for (int l = 0; l < 8; ++l) sum += hit.ray.tfar[l];
    }
  }
  return sum;
}

void trace_ping(benchmark::State& state, const char* place) {
  using Clock = std::chrono::steady_clock;
  const Setup setup(place);
  double bare_s = 0;
  double traced_s = 0;
  double multipath_s = 0;
  for (auto _ : state) {
    for (const Pose& pose : setup.poses) {
      const auto start = Clock::now();
      benchmark::DoNotOptimize(bare_cast(setup, pose));
      const auto middle = Clock::now();
      benchmark::DoNotOptimize(setup.tracer.trace(pose));
      const auto end = Clock::now();
      benchmark::DoNotOptimize(setup.multipath.trace(pose, 2));
      multipath_s += std::chrono::duration<double>(Clock::now() - end).count();
      bare_s += std::chrono::duration<double>(middle - start).count();
      traced_s += std::chrono::duration<double>(end - middle).count();
    }
  }
  const auto pings = static_cast<double>(state.iterations()) * poses_along_path;
  state.counters["bare_ms"] = 1e3 * bare_s / pings;
  state.counters["trace_ms"] = 1e3 * traced_s / pings;
  state.counters["multipath_ms"] = 1e3 * multipath_s / pings;
  state.counters["ratio_to_bare"] = traced_s / bare_s;
}

void pose_to_image(benchmark::State& state, const char* place) {
  const Setup setup(place);
  const tbb::global_control threads(tbb::global_control::max_allowed_parallelism,
                                    static_cast<std::size_t>(state.range(0)));
  for (auto _ : state) {
    parallel_for(poses_along_path, [&](int i) {
      const Ping ping = setup.tracer.trace(setup.poses[static_cast<std::size_t>(i)]);
      const RandomKey key = RandomKey::from_seed(static_cast<std::uint64_t>(i));
      benchmark::DoNotOptimize(
          form_images(setup.receiver, ping, setup.settings, {.ping = key}).raw.grey.pixels().data());
    });
  }
  state.counters["pings_per_s"] =
      benchmark::Counter(static_cast<double>(state.iterations()) * poses_along_path, benchmark::Counter::kIsRate);
}

/// Core time of a whole ping with every stage of a profile, pose to grey image.
void whole_ping(benchmark::State& state, const char* place, const char* profile) {
  using Clock = std::chrono::steady_clock;
  Setup setup(place);
  SampledValues sampled;
  setup.settings.noise = sample_noise(load_noise(profile), RandomKey{}, sampled);
  double trace_s = 0;
  double form_s = 0;
  for (auto _ : state) {
    for (const Pose& pose : setup.poses) {
      const auto start = Clock::now();
      const Ping ping = setup.tracer.trace(pose, trace_options(setup.settings.noise, false));
      const auto middle = Clock::now();
      benchmark::DoNotOptimize(
          form_images(setup.receiver, ping, setup.settings, setup.setting(pose)).raw.grey.pixels().data());
      const auto end = Clock::now();
      trace_s += std::chrono::duration<double>(middle - start).count();
      form_s += std::chrono::duration<double>(end - middle).count();
    }
  }
  const auto pings = static_cast<double>(state.iterations()) * poses_along_path;
  state.counters["trace_ms"] = 1e3 * trace_s / pings;
  state.counters["images_ms"] = 1e3 * form_s / pings;
  state.counters["ping_ms"] = 1e3 * (trace_s + form_s) / pings;
}

BENCHMARK_CAPTURE(whole_ping, pier_harbor_paper, "pier_harbor", "paper")->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(whole_ping, pier_harbor_oculus_tank, "pier_harbor", "oculus_tank")->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(whole_ping, pier_harbor_harsh, "pier_harbor", "harsh")->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(whole_ping, test_tank_oculus_tank, "test_tank", "oculus_tank")->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(trace_ping, pier_harbor, "pier_harbor")->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(trace_ping, boulder_field, "boulder_field")->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(trace_ping, test_tank, "test_tank")->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(pose_to_image, pier_harbor, "pier_harbor")
    ->Arg(1)
    ->Arg(2)
    ->UseRealTime()
    ->Unit(benchmark::kMillisecond);

}  // namespace

int main(int argc, char** argv) {
  ensonify::keep_freed_pages();  // as the program does
  benchmark::Initialize(&argc, argv);
  benchmark::RunSpecifiedBenchmarks();
}
