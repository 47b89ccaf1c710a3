#include <benchmark/benchmark.h>
#include <fmt/format.h>
#include <tbb/global_control.h>

#include <chrono>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <opencv2/core.hpp>

#include "ensonify/core/error.hpp"
#include "ensonify/core/memory.hpp"
#include "ensonify/core/parallel.hpp"
#include "ensonify/core/random.hpp"
#include "ensonify/filters/filter_chain.hpp"
#include "ensonify/filters/filter_registry.hpp"
#include "ensonify/output/child_process.hpp"

namespace {

using namespace ensonify;

constexpr int side = 512;

/// Targets on a bottom that falls off, times Rayleigh numbers of mean 1.
GreyImage speckled() {
  const RandomKey key = RandomKey::from_seed(1).child("filter_bench");
  GreyImage image{Image2<float>(side, side), GreyDepth::real};
  for (int i = 0; i < side; ++i) {
    for (int j = 0; j < side; ++j) {
      const bool target = (i / 64 + j / 64) % 5 == 0;
      const double u = uniform_at(key, static_cast<std::uint64_t>(i) * side + static_cast<std::uint64_t>(j));
      const double rayleigh = std::sqrt(-4.0 / M_PI * std::log(u));
      image.grey(i, j) = static_cast<float>(std::min((target ? 120.0 : 10.0 + 40.0 * i / side) * rayleigh, 255.0));
    }
  }
  return image;
}

/// Milliseconds of scikit-image and scipy on such an image, one thread, in a process of their own; empty without them.
std::map<std::string, double> python_ms() {
  const std::string script = R"(
import json, time, numpy as np, scipy.signal, scipy.ndimage
from skimage.restoration import denoise_wavelet, denoise_bilateral, denoise_nl_means, estimate_sigma
image = (60 * np.random.default_rng(1).rayleigh(0.8, (512, 512))).clip(0, 255).astype(np.float32)
def ms(f):
    times = []
    for _ in range(5):
        start = time.perf_counter(); f(); times.append(time.perf_counter() - start)
    return 1e3 * min(times)
print(json.dumps({
    'wavelet': ms(lambda: denoise_wavelet(image, sigma=estimate_sigma(image) / 4, method='VisuShrink', mode='soft', rescale_sigma=True)),
    'wiener': ms(lambda: scipy.signal.wiener(image, 5)),
    'median': ms(lambda: scipy.ndimage.median_filter(image, 5, mode='mirror')),
}))
)";
  try {
    const auto text =
        run_program({"/usr/bin/python3", "-"}, {reinterpret_cast<const std::uint8_t*>(script.data()), script.size()},
                    "install python3-skimage");
    return nlohmann::json::parse(text.begin(), text.end()).get<std::map<std::string, double>>();
  } catch (const Error& e) {
    fmt::print("no comparison with Python's libraries: {}\n", e.what());
    return {};
  }
}

/// One filter, one core. vs_python = time of scikit-image or scipy over ours.
void one_core(benchmark::State& state, const FilterStep& step, double python_ms) {
  const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
  cv::setNumThreads(1);
  const GreyImage image = speckled();
  const FilterChain chain{"bench", {step}};
  double best_s = INFINITY;
  for (auto _ : state) {
    const auto begin = std::chrono::steady_clock::now();
    benchmark::DoNotOptimize(apply(chain, image).grey.pixels().data());
    best_s = std::min(best_s, std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count());
  }
  state.counters["best_ms"] = best_s * 1e3;
  if (python_ms > 0) state.counters["vs_python"] = python_ms / (best_s * 1e3);
}

/// 64 images with all cores over the same with one: `speedup`.
void many_images(benchmark::State& state) {
  const GreyImage image = speckled();
  const FilterChain chain{"bench", {make_filter("lee_enhanced")}};
  const auto seconds = [&](std::size_t threads) {
    const tbb::global_control control(tbb::global_control::max_allowed_parallelism, threads);
    const auto begin = std::chrono::steady_clock::now();
    parallel_for(64, [&](int) { benchmark::DoNotOptimize(apply(chain, image).grey.pixels().data()); });
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  };
  double one_s = 0, two_s = 0;
  for (auto _ : state) {
    one_s += seconds(1);
    two_s += seconds(2);
  }
  state.counters["speedup_2_cores"] = one_s / two_s;
}

}  // namespace

int main(int argc, char** argv) {
  keep_freed_pages();
  benchmark::Initialize(&argc, argv);
  const auto rivals = python_ms();
  for (const MethodInfo& method : filter_methods()) {
    if (!method.ready) continue;
    const auto rival = rivals.find(method.name);
    const FilterStep step = make_filter(method.name);
    const double rival_ms = rival == rivals.end() ? 0.0 : rival->second;
    benchmark::RegisterBenchmark(method.name.c_str(), [=](benchmark::State& s) {
      one_core(s, step, rival_ms);
    })->Unit(benchmark::kMillisecond);
  }
  for (const char* window : {"5", "21", "61"}) {
    FilterStep step = make_filter("lee");
    set_parameter(step, "window", window);
    benchmark::RegisterBenchmark(fmt::format("lee/window:{}", window).c_str(), [=](benchmark::State& s) {
      one_core(s, step, 0.0);
    })->Unit(benchmark::kMillisecond);
  }
  benchmark::RegisterBenchmark("64_images", many_images)->Unit(benchmark::kMillisecond);
  benchmark::RunSpecifiedBenchmarks();
}
