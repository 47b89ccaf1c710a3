/// What Python adds to a ping: the same 512 x 512 ping by C++ and by ensonify.Simulator in turn, in one process, one
/// thread each. Counters (medians):
///   cpp_ms, python_ms  of a ping with all images and truth, given back and let go
///   over_ms            of python - cpp, pair by pair (asked: at most 0.3)
#include <benchmark/benchmark.h>
#include <pybind11/embed.h>
#include <pybind11/numpy.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <chrono>
#include <vector>

#include "ensonify/generators/simulator.hpp"

namespace {

using namespace ensonify;
namespace py = pybind11;

double median(std::vector<double> values) {
  std::ranges::nth_element(values, values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2));
  return values[values.size() / 2];
}

template <typename Work>
double milliseconds(const Work& work) {
  const auto start = std::chrono::steady_clock::now();
  work();
  return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
}

void ping(benchmark::State& state, const char* place, const char* noise) {
  const py::module_ ensonify = py::module_::import("ensonify");
  ensonify.attr("set_threads")(1);
  const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
  const Scene scene = load_scene(place);
  const Pose pose = scene.waypoints.front();
  const Simulator simulator(scene, load_sonar("oculus_m1200d_hf"), load_noise(noise));
  const py::object python = ensonify.attr("Simulator")(place, "oculus_m1200d_hf", noise).attr("ping");
  const py::object matrix = ensonify.attr("Scene")(place).attr("waypoints")[py::int_(0)];

  std::vector<double> cpp_ms, python_ms, over_ms;
  std::uint64_t seed = 0;
  for (auto _ : state) {
    ++seed;
    const auto by_cpp = [&] { benchmark::DoNotOptimize(simulator.ping({pose, {}, ping_keys(seed, 0)})); };
    const auto by_python = [&] { python(matrix, seed).attr("raw"); };
    // In turns, so that neither always finds the other's caches.
    if (seed % 2 == 0) cpp_ms.push_back(milliseconds(by_cpp));
    python_ms.push_back(milliseconds(by_python));
    if (seed % 2 != 0) cpp_ms.push_back(milliseconds(by_cpp));
    over_ms.push_back(python_ms.back() - cpp_ms.back());
  }
  state.counters["cpp_ms"] = median(cpp_ms);
  state.counters["python_ms"] = median(python_ms);
  state.counters["over_ms"] = median(over_ms);
}

}  // namespace

int main(int argc, char** argv) {
  const py::scoped_interpreter python;
  py::module_::import("sys").attr("path").attr("insert")(0, ENSONIFY_PYTHON_PATH);
  benchmark::RegisterBenchmark("ping/test_tank/paper", ping, "test_tank", "paper")->Iterations(500);
  benchmark::RegisterBenchmark("ping/pier_harbor/paper", ping, "pier_harbor", "paper")->Iterations(500);
  benchmark::RegisterBenchmark("ping/pier_harbor/oculus_tank", ping, "pier_harbor", "oculus_tank")->Iterations(200);
  benchmark::Initialize(&argc, argv);
  benchmark::RunSpecifiedBenchmarks();
}
