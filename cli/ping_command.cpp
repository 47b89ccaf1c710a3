#include <fmt/format.h>

#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>

#include "ensonify/cli/arguments.hpp"
#include "ensonify/cli/commands.hpp"
#include "ensonify/cli/signals.hpp"
#include "ensonify/cli/truth_warnings.hpp"
#include "ensonify/generators/describe.hpp"
#include "ensonify/generators/json_text.hpp"
#include "ensonify/generators/simulator.hpp"
#include "ensonify/generators/truth_channels.hpp"
#include "ensonify/output/atomic_file.hpp"
#include "ensonify/output/fan_view.hpp"
#include "ensonify/output/png.hpp"
#include "ensonify/sensor_models/receive_chain.hpp"

namespace ensonify::cli {
namespace {

struct Arguments {
  std::string scene;
  std::uint64_t layout = 0;
  std::string sonar;
  std::string pose;
  std::string velocity = "0 0 0 0 0 0";
  std::string noise = "paper";
  std::uint64_t seed = 0;
  std::uint64_t frame = 0;
  std::string out;
  double range_max_m = 0;
  std::string range_bins;
  std::string isa = default_isa;
};

RangeWindow window_of(const Arguments& a) {
  RangeWindow window;
  if (a.range_max_m > 0) window.range_max_m = a.range_max_m;
  if (!a.range_bins.empty()) window.range_bins = a.range_bins == "native" ? 0 : std::stoi(a.range_bins);
  return window;
}

/// Share of the mask, and null or the ranges of the first bin with an echo in it and of the nearest surface.
nlohmann::json summary(const PingImages& images, const PingTruth& truth, const SonarGeometry& geometry) {
  const auto mask = images.mask.pixels();
  const auto first = std::find(mask.begin(), mask.end(), 255);
  const auto nearest_hit =
      std::min_element(truth.first_hit_range_m.pixels().begin(), truth.first_hit_range_m.pixels().end());
  nlohmann::json result{
      {"mask_share", static_cast<double>(std::count(mask.begin(), mask.end(), 255)) / static_cast<double>(mask.size())},
      {"first_echo_range_m", nullptr},
      {"nearest_surface_m", nullptr}};
  if (first != mask.end()) {
    const auto row = static_cast<int>((first - mask.begin()) / images.mask.columns());
    result["first_echo_range_m"] = geometry.bin_centre_m(row);
  }
  if (std::isfinite(*nearest_hit)) result["nearest_surface_m"] = *nearest_hit;
  return result;
}

void run(const Arguments& a) {
  const SonarModel sonar = open_sonar(a.sonar, window_of(a));
  const NoiseProfile profile = load_noise(a.noise);
  const Pose T_world_sonar = parse_pose(a.pose);
  const Scene scene = open_scene(a.scene, a.layout);
  const Simulator simulator(scene, sonar, profile, a.isa);
  const auto [ping, images, sampled] =
      simulator.ping({T_world_sonar, parse_twist(a.velocity), ping_keys(a.seed, a.frame)});

  nlohmann::json record{{"scene", scene.name},
                        {"layout", scene.layout},
                        {"sonar", describe(sonar)},
                        {"noise", describe(profile)},
                        {"seed", a.seed},
                        {"frame", a.frame},
                        {"isa", a.isa},
                        {"mask", {{"threshold", default_mask_threshold}}},
                        {"T_world_sonar", describe(T_world_sonar)},
                        {"velocity", a.velocity},
                        {"water",
                         {{"sound_speed_mps", sound_speed_mps(scene.water)},
                          {"absorption_db_per_m", absorption_db_per_m(scene.water, sonar.frequency_hz)}}}};
  record.update(summary(images, ping.truth, sonar.geometry));
  for (const auto& [name, value] : sampled) record["sampled"][name] = value;
  for (std::size_t i = 0; i < scene.instances.size(); ++i) record["instances"].push_back(scene.instances[i].name);
  const std::filesystem::path out = a.out;
  write_unbroken(out, [&, &ping = ping, &images = images] {
    write_file(out / "raw.png",
               sonar.receive.bits == 16 ? encode_png(quantise16(images.raw.level)) : encode_png(images.raw.grey));
    write_file(out / "clean.png", encode_png(images.clean.grey));
    write_file(out / "mask.png", encode_png(images.mask));
    write_file(out / "labels.png", encode_png(images.labels));
    write_file(out / "fan.png", encode_png(fan_view(images.raw.grey, sonar.geometry, 720)));
    std::vector<Channel> layers{{"direct", ping.echo.direct}};
    if (!images.multipath.empty()) layers.emplace_back("multipath", images.multipath);
    write_exr(out / "echo.exr", layers, truth_comment);
    write_exr(out / "truth.exr", truth_channels(ping.echo, images, ping.truth), truth_comment);
    write_file(out / "ping.json", json_text(record));
  });

  warn_of_place(scene, T_world_sonar.translation(), record["nearest_surface_m"].is_null(), sonar.geometry.range_min_m,
                sonar.geometry.range_max_m);
  fmt::print("{} x {} pixels in {}: mask {:.1f} %, nearest surface {} m\n", images.raw.grey.rows(),
             images.raw.grey.columns(), a.out, 100.0 * record["mask_share"].get<double>(),
             record["nearest_surface_m"].is_null() ? "none"
                                                   : fmt::format("{:.2f}", record["nearest_surface_m"].get<double>()));
}

}  // namespace

void add_ping(CLI::App& app) {
  auto* command = app.add_subcommand("ping", "Simulate one ping and write its images and truth");
  auto a = std::make_shared<Arguments>();
  command->add_option("SCENE", a->scene, "Scene YAML, bundled name (see: ensonify scene list), or a mesh file")
      ->required();
  command->add_option("--sonar", a->sonar, "Sonar YAML or bundled name (see: ensonify sonar list)")->required();
  command
      ->add_option("--pose", a->pose,
                   "\"x y z roll pitch yaw\" of the sonar: metres (z up, 0 at the surface) and degrees "
                   "(positive pitch is nose down)")
      ->required();
  command
      ->add_option("--velocity", a->velocity,
                   "\"vx vy vz wx wy wz\" of the sonar in its own frame while the sound is under way: m/s and deg/s")
      ->capture_default_str();
  command
      ->add_option("--out", a->out,
                   "Folder for raw.png clean.png mask.png labels.png fan.png echo.exr truth.exr ping.json")
      ->required()
      ->check(some_path());
  command->add_option("--noise", a->noise, "Noise YAML or bundled name: paper, none, oculus_tank, ... (docs/noise.md)")
      ->capture_default_str();
  command->add_option("--seed", a->seed, "Seed of the noise: scatterers, device and all that is drawn")
      ->check(whole_number())
      ->capture_default_str();
  command
      ->add_option("--frame", a->frame, "Number of the ping: another one has new receiver noise over the same speckle")
      ->check(whole_number())
      ->capture_default_str();
  command->add_option("--layout", a->layout, "Layout of the scene")->check(whole_number())->capture_default_str();
  command->add_option("--range-max", a->range_max_m, "End of the range window in metres")->check(above_zero());
  command->add_option("--range-bins", a->range_bins, "Range bins of the image, or native")
      ->check(CLI::IsMember({"native"}) | CLI::Range(1, 16384));
  command->add_option("--isa", a->isa, "Instruction set of the ray caster")
      ->check(CLI::IsMember({"avx2", "avx512", "sse4.2", "sse2", "auto"}));
  command->footer(
      "Example:\n"
      "  ensonify ping test_tank --sonar oculus_m1200d_hf --pose \"1.0 0 -1.5 0 10 0\" --out out/ping\n"
      "  ensonify ping glider.dae --sonar oculus_m1200d_hf --pose \"-3 0 0 0 0 0\" --out out/glider");
  command->callback([a] { run(*a); });
}

}  // namespace ensonify::cli
