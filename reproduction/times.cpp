#include "ensonify/reproduction/times.hpp"

#include <algorithm>
#include <chrono>
#include <functional>

#include "ensonify/generators/simulator.hpp"
#include "ensonify/generators/split_frames.hpp"

namespace ensonify {
namespace {

double seconds_of(const std::function<void()>& work) {
  const auto begin = std::chrono::steady_clock::now();
  work();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}

double median(std::vector<double> values) {
  std::ranges::nth_element(values, values.begin() + values.size() / 2);
  return values[values.size() / 2];
}

std::vector<GreyImage> some_images(const Dataset& dataset, int frames) {
  const SplitFrames chosen = choose_frames(dataset, "test", frames);
  std::vector<GreyImage> images(chosen.numbers.size());
  visit_frames(dataset, chosen,
               [&](int at, const JudgedFrame& frame) { images[static_cast<std::size_t>(at)] = frame.raw; });
  return images;
}

}  // namespace

Times measure_times(const Dataset& dataset, const std::vector<Contender>& contenders, int frames) {
  Times times;
  const std::vector<GreyImage> images = some_images(dataset, frames);
  for (const Contender& contender : contenders) {
    const FilterChain chain = chain_of(contender);
    if (chain.steps.empty() || images.empty()) continue;
    apply(chain, images.front());  // tables, and of a network its plan
    std::vector<double> each;
    for (const GreyImage& image : images) each.push_back(seconds_of([&] { apply(chain, image); }));
    times.filters.push_back({contender.label, median(std::move(each))});
  }
  const Scene scene = open_scene(std::string("pier_harbor"));
  RangeWindow window{0.1, 5.0, 512};
  for (const char* noise : {"none", "paper", "oculus_tank"}) {
    const Simulator simulator(scene, load_sonar("oculus_m1200d_hf", window), load_noise(noise));
    std::vector<double> each;
    for (int i = 0; i < frames + 1; ++i) {
      const auto at = static_cast<std::size_t>(i) % scene.waypoints.size();
      const PingRequest request{scene.waypoints[at], {}, ping_keys(0, static_cast<std::uint64_t>(i)), false};
      const double s = seconds_of([&] { simulator.ping(request); });
      if (i > 0) each.push_back(s);
    }
    times.pings.push_back({noise, median(std::move(each))});
  }
  return times;
}

}  // namespace ensonify
