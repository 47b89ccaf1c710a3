#include "ensonify/reproduction/real_pings.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "ensonify/filters/filter_chain.hpp"
#include "ensonify/generators/simulator.hpp"
#include "ensonify/output/atomic_file.hpp"
#include "ensonify/output/png.hpp"
#include "ensonify/reproduction/contenders.hpp"

namespace ensonify {
namespace {

namespace fs = std::filesystem;

void simulate_pings(const fs::path& folder) {
  const Simulator simulator(open_scene(resolve_name("reproduction", "rough_tank").string()),
                            load_sonar(std::string("oculus_m1200d_hf_256")), load_noise(std::string("oculus_tank")));
  Pose T_world_sonar = Pose::Identity();
  T_world_sonar.translation() = Vec3(0.9, 0.3, -0.55);
  T_world_sonar.linear() =
      (Eigen::AngleAxisd(radians(10), Vec3::UnitZ()) * Eigen::AngleAxisd(radians(38), Vec3::UnitY()))
          .toRotationMatrix();
  for (int i = 0; i < 3; ++i) {
    const auto made = simulator.ping({T_world_sonar, {}, ping_keys(0, static_cast<std::uint64_t>(i)), false});
    write_file(folder / fmt::format("{:06}.png", i), encode_png(made.images.raw.grey));
  }
}

Image2<std::uint8_t> shown(const Image2<float>& grey) {
  Image2<std::uint8_t> image(grey.rows(), grey.columns());
  std::ranges::transform(grey.pixels(), image.pixels().begin(),
                         [](float x) { return static_cast<std::uint8_t>(std::lrint(std::clamp(x, 0.0F, 255.0F))); });
  return resized(image, std::min(grey.rows(), 352), std::min(grey.columns(), 256));
}

ContactRow row_of(const std::string& label, const PingSeries& pings) {
  const GreyImage ping = read_ping(pings, 0);
  ContactRow row{label, {{"raw", {shown(ping.grey)}}}};
  if (has_model(usual_model)) {
    row.tiles.push_back({"mask", {shown(apply(find_filter("unet"), ping).grey)}});
    row.tiles.push_back({"clean", {shown(apply(find_filter("unet_clean"), ping).grey)}});
  }
  return row;
}

}  // namespace

RealFindings beside_real_pings(const fs::path& real, const fs::path& simulated) {
  const PingSeries real_pings = open_pings(real, "test");
  simulate_pings(simulated);
  const PingSeries simulated_pings = open_pings(simulated, "test");
  const auto quiet = [](int, int) {};
  return {describe_side(simulated_pings, {}, quiet),
          describe_side(real_pings, {}, quiet),
          {"", {row_of("real", real_pings), row_of("simulated", simulated_pings)}}};
}

}  // namespace ensonify
