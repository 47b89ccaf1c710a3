#include <benchmark/benchmark.h>
#include <fmt/format.h>
#include <tbb/global_control.h>
#include <tbb/info.h>

#include <chrono>
#include <cmath>
#include <filesystem>
#include <oneapi/dnnl/dnnl.hpp>
#include <vector>

#include "ensonify/config/library.hpp"
#include "ensonify/core/memory.hpp"
#include "ensonify/core/parallel.hpp"
#include "ensonify/filters/learned_model.hpp"
#include "support/network_maker.hpp"

/// Images of 512 x 512 through the networks of ensonify.training.
namespace {

using namespace ensonify;

constexpr int side = 512;

double seconds_of(const auto& call) {
  const auto begin = std::chrono::steady_clock::now();
  call();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}

/// Multiplications that a network needs for one image, whoever computes it.
double multiplications(const OnnxFile& file) {
  std::map<std::string, double> pixels{{file.input, 1.0 * side * side}};
  double sum = 0;
  for (const OnnxNode& node : file.nodes) {
    const double in = pixels.at(node.inputs.front());
    double out = in;
    if (node.operation.starts_with("Conv")) {
      const OnnxTensor& weights = file.tensors.at(node.inputs[1]);
      const bool halves = weights.shape[2] == 4, up = node.operation == "ConvTranspose";
      if (halves) out = up ? in * 4 : in / 4;
      sum += static_cast<double>(weights.values.size()) * (up ? in : out);
    }
    pixels[node.outputs.front()] = out;
  }
  return sum;
}

/// Multiplications a second of one core in oneDNN's product of two matrices of 768 x 768: the limit.
double limit_per_s() {
  constexpr int n = 768;
  const std::vector<float> a(n * n, 1.0F), b(n * n, 0.5F);
  std::vector<float> c(n * n);
  return 1.0 * n * n * n /
         seconds_of([&] { dnnl_sgemm('N', 'N', n, n, n, 1.0F, a.data(), n, b.data(), n, 0.0F, c.data(), n); });
}

/// `of_limit`: share of the time that the multiplications alone would take at the rate of a matrix product of the same
/// run, on as many cores.
void one_image(benchmark::State& state, const Network& network, double multiplications, int threads) {
  const tbb::global_control control(tbb::global_control::max_allowed_parallelism, static_cast<std::size_t>(threads));
  Image2<float> image(side, side, 0.25F);
  network.run(image);
  std::vector<double> times_s;
  double limit = 0;
  for (auto _ : state) {
    times_s.push_back(seconds_of([&] { benchmark::DoNotOptimize(network.run(image).front().pixels().data()); }));
    state.PauseTiming();
    limit = std::max(limit, limit_per_s());
    state.ResumeTiming();
  }
  std::ranges::sort(times_s);
  state.counters["best_ms"] = 1e3 * times_s.front();
  state.counters["median_ms"] = 1e3 * times_s[times_s.size() / 2];
  state.counters["GMAC_per_s"] = 1e-9 * multiplications / times_s.front();
  state.counters["of_limit"] = multiplications / times_s.front() / (limit * threads);
}

/// 16 images on all cores: milliseconds each.
void many_images(benchmark::State& state, const Network& network) {
  const Image2<float> image(side, side, 0.25F);
  double best_s = INFINITY;
  for (auto _ : state)
    best_s = std::min(best_s, seconds_of([&] { parallel_for(16, [&](int) { network.run(image); }); }));
  state.counters["ms_an_image"] = 1e3 * best_s / 16;
}

void bundled_model(benchmark::State& state, const std::filesystem::path& file) {
  const LearnedModel model(file);
  const Image2<float> image(side, side, 60.0F);
  double best_s = INFINITY;
  for (auto _ : state) best_s = std::min(best_s, seconds_of([&] { model.outputs(image); }));
  state.counters["best_ms"] = 1e3 * best_s;
}

}  // namespace

int main(int argc, char** argv) {
  keep_freed_pages();
  setenv("OMP_NUM_THREADS", "1", 1);  // the matrix product's
  benchmark::Initialize(&argc, argv);
  std::vector<std::pair<Network, double>> networks;
  for (const int ngf : {8, 16}) {
    const OnnxFile file = random_unet(ngf, 6, 2);
    networks.emplace_back(Network(file), multiplications(file));
  }
  const int cores = tbb::info::default_concurrency();
  for (int i = 0; i < 2; ++i) {
    const auto& [network, count] = networks[i];
    for (const int threads : {1, cores}) {
      benchmark::RegisterBenchmark(
          fmt::format("unet/ngf:{}/cores:{}", 8 << i, threads).c_str(),
          [&network = network, count = count, threads](benchmark::State& s) { one_image(s, network, count, threads); })
          ->Unit(benchmark::kMillisecond);
    }
    benchmark::RegisterBenchmark(fmt::format("16_images/ngf:{}", 8 << i).c_str(), [&network =
                                                                                       network](benchmark::State& s) {
      many_images(s, network);
    })->Unit(benchmark::kMillisecond);
  }
  for (const std::string& name : library_names("filters/models", ".onnx")) {
    const std::filesystem::path file = resolve_name("filters/models", name, ".onnx");
    benchmark::RegisterBenchmark(name.c_str(), [=](benchmark::State& s) {
      bundled_model(s, file);
    })->Unit(benchmark::kMillisecond);
  }
  benchmark::RunSpecifiedBenchmarks();
}
