#include <fmt/format.h>
#include <tbb/global_control.h>

#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "ensonify/cli/arguments.hpp"
#include "ensonify/cli/commands.hpp"
#include "ensonify/cli/progress.hpp"
#include "ensonify/cli/signals.hpp"
#include "ensonify/generators/describe.hpp"
#include "ensonify/generators/explore.hpp"
#include "ensonify/generators/explore_files.hpp"
#include "ensonify/generators/explore_gate.hpp"
#include "ensonify/generators/explore_pictures.hpp"
#include "ensonify/generators/explore_plugin.hpp"
#include "ensonify/generators/json_text.hpp"
#include "ensonify/mapping/map_conversion.hpp"
#include "ensonify/output/atomic_file.hpp"
#include "ensonify/output/grid_files.hpp"
#include "ensonify/output/png.hpp"

namespace ensonify::cli {
namespace {

namespace fs = std::filesystem;

struct Arguments {
  std::string scene, out, start, gate, plugin, range_bins;
  std::uint64_t layout = 0;
  std::uint64_t seed = 0;
  ExploreChoice choice;
  double resolution_m = 0, depth_m = 0, known_free_m = 0;
  Vehicle vehicle;
  double turn_rate_degps = 30;
  double drift_m = 0;
  int pictures_every = 50;
  double plugin_timeout_s = 10;
  int jobs = 0;
  bool force = false;
  std::string isa = default_isa, progress = "auto";
};

SonarModel sonar_of(const Arguments& a) {
  RangeWindow window;
  window.range_max_m = a.choice.range_max_m;
  if (!a.range_bins.empty()) window.range_bins = a.range_bins == "native" ? 0 : std::stoi(a.range_bins);
  return open_sonar(a.choice.sonar, window);
}

ExploreSettings settings_of(const Arguments& a) {
  ExploreSettings settings = explore_settings(a.choice);
  settings.seed = a.seed;
  if (a.drift_m > 0) settings.drift = Drift{a.drift_m, 1200};
  return settings;
}

ExploreSite site_of(const Arguments& a, const Scene& scene, const SonarModel& sonar, const InverseModel& model) {
  SiteRequest request;
  if (a.resolution_m > 0) request.resolution_m = a.resolution_m;
  if (a.depth_m > 0) request.z_m = -a.depth_m;
  if (!a.start.empty()) request.start = parse_pose(a.start, "--start");
  if (a.known_free_m > 0) request.known_free_m = a.known_free_m;
  return explore_site(scene, sonar, model, a.vehicle, request);
}

/// Takes away the files of a run: those of an older one, or of one that went wrong.
void remove_run(const fs::path& out) {
  std::error_code no_throw;
  for (const auto& entry : fs::directory_iterator(out, no_throw)) {
    const std::string name = entry.path().filename().string();
    const bool ours = name == "steps.csv" || name == "steps.jsonl" || name == "times.csv" || name == "summary.json" ||
                      name == "map.npz" || name == "map.pgm" || name == "map.yaml" || name == "final.png" ||
                      (name.starts_with("step_") && name.ends_with(".png"));
    if (ours) fs::remove(entry.path());
  }
}

void prepare_folder(const Arguments& a) {
  const fs::path out(a.out);
  if (fs::exists(out) && !fs::is_directory(out)) throw ConfigError(fmt::format("{}: is no folder", a.out));
  if (!fs::exists(out) || fs::is_empty(out)) return;
  if (!a.force) {
    throw ConfigError(fmt::format("{}: is not empty; choose another --out, or --force to replace a run", a.out));
  }
  remove_abandoned_beside(out);
  remove_run(out);
}

nlohmann::json asked(const Arguments& a, const SonarModel& sonar, const NoiseProfile& noise, const ExploreSite& site) {
  return {{"layout", a.layout},
          {"sonar", describe(sonar)},
          {"noise", describe(noise)},
          {"filter", a.choice.filter},
          {"model", a.choice.model},
          {"p_free", a.choice.p_free},
          {"p_occupied", a.choice.p_occupied},
          {"threshold", a.choice.threshold},
          {"seed", a.seed},
          {"isa", a.isa},
          {"drift_radial_error_m", a.drift_m},
          {"most_steps", a.choice.steps},
          {"radius_m", a.vehicle.radius_m},
          {"height_m", a.vehicle.height_m},
          {"margin_m", a.vehicle.margin_m},
          {"speed_mps", a.vehicle.limits.speed_mps},
          {"turn_rate_degps", a.turn_rate_degps},
          {"ping_rate_hz", a.vehicle.limits.ping_rate_hz},
          {"plugin", a.plugin},
          {"T_world_sonar_start", describe(site.start)}};
}

void write_results(const fs::path& out, const ExploreRun& run, const ExploreSite& site, const nlohmann::json& summary) {
  write_explored_map(run.grid, out / "map.npz");
  GridFileOptions options;
  options.unobserved_is_unknown = true;
  options.slice_z_m = site.start.translation().z();
  write_grid(occupancy_of(dense_map(run.grid)), out / "map.pgm", options);
  write_file(out / "steps.csv", steps_csv(run));
  write_file(out / "steps.jsonl", steps_jsonl(run));
  write_file(out / "times.csv", times_csv(run));
  write_file(out / "summary.json", json_text(summary));  // last: a folder with it is complete
}

ExploreRun run_loop(const Arguments& a, const Simulator& simulator, const ExploreSite& site,
                    const ExploreSettings& settings) {
  const SonarModel& sonar = simulator.sonar();
  const fs::path out(a.out);
  ProgressLine progress(parse_progress_style(a.progress));
  std::optional<ExplorePlugin> plugin;
  ExploreHooks hooks;
  if (!a.plugin.empty()) {
    plugin.emplace(PluginSettings{a.plugin, a.plugin_timeout_s, out / "plugin", [] { return caught_signal() != 0; }},
                   site, a.vehicle, sonar, a.choice.steps);
    hooks.guest = [&](const ExploreMoment& moment) { return plugin->ask(moment); };
  }
  hooks.after_step = [&](const ExploreMoment& moment, const Slice& map, const std::vector<ExploreStep>& so_far) {
    if (a.pictures_every > 0 && moment.step % a.pictures_every == 0) {
      const auto strip = explore_strip(moment.ping, sonar.geometry, map, so_far, site, a.vehicle.radius_m);
      write_file(out / fmt::format("step_{:06}.png", moment.step), encode_png(strip));
    }
    progress.show("explore", moment.step + 1, moment.step + 1, a.choice.steps);
    return caught_signal() == 0;
  };
  return explore(simulator, site, a.vehicle, settings, hooks);
}

std::string share(const nlohmann::json& value) {
  return value.is_null() ? "none" : fmt::format("{:.2f} %", 100 * value.get<double>());
}

void run(Arguments& a) {
  std::optional<tbb::global_control> jobs;
  if (a.jobs > 0) jobs.emplace(tbb::global_control::max_allowed_parallelism, static_cast<std::size_t>(a.jobs));
  a.vehicle.limits.turn_radps = radians(a.turn_rate_degps);
  std::optional<ExploreGate> gate;
  if (!a.gate.empty()) gate = load_gate(a.gate);
  const SonarModel sonar = sonar_of(a);
  const NoiseProfile noise = load_noise(a.choice.noise);
  const ExploreSettings settings = settings_of(a);
  const Scene scene = open_scene(a.scene, a.layout);
  const ExploreSite site = site_of(a, scene, sonar, settings.model);
  prepare_folder(a);
  watch_signals();

  nlohmann::json summary;
  std::vector<GateLine> lines;
  try {
    const Simulator simulator(scene, sonar, noise, a.isa);
    const ExploreRun run = run_loop(a, simulator, site, settings);
    if (caught_signal() != 0) throw DataError("stopped");
    summary = summary_of(run, site, a.vehicle);
    summary["scene"] = scene.name;
    summary["settings"] = asked(a, sonar, noise, site);
    if (gate) lines = judge(*gate, run.steps);
    for (const GateLine& line : lines) summary["gate"].push_back({{"passed", line.passed}, {"text", line.text}});
    write_file(fs::path(a.out) / "final.png",
               encode_png(explore_strip(run.ping, sonar.geometry, run.map, run.steps, site, a.vehicle.radius_m)));
    write_results(a.out, run, site, summary);
  } catch (const std::exception&) {
    remove_run(a.out);
    std::error_code no_throw;
    fs::remove(a.out, no_throw);  // where it is empty
    if (caught_signal() != 0) throw ExitCode{128 + caught_signal()};
    throw;
  }
  if (caught_signal() != 0) throw ExitCode{128 + caught_signal()};

  fmt::print("{} steps, {}: coverage {}, boundary found {}, FPR {}, FNR {}, clearance {:.2f} m, way {:.1f} m in {}\n",
             summary["steps"].get<int>(), summary["end"].get<std::string>(), share(summary["coverage"]),
             share(summary["boundary_found"]), share(summary["fpr"]), share(summary["fnr"]),
             summary["least_clearance_m"].get<double>(), summary["path_m"].get<double>(), a.out);
  for (const GateLine& line : lines) fmt::print("{}\n", line.text);
  if (!all_passed(lines)) throw ExitCode{1};
}

void add_loop_options(CLI::App& command, Arguments& a) {
  command
      .add_option("--filter", a.choice.filter,
                  "Method or chain between ping and mapper (ensonify filter --list), or none")
      ->capture_default_str();
  command.add_option("--model", a.choice.model, "What a ping says of cells (docs/mapping.md)")
      ->check(CLI::IsMember({"points", "arc", "arc_shadow", "carve"}))
      ->capture_default_str();
  command.add_option("--threshold", a.choice.threshold, "Least grey level of an echo, after the filter")
      ->check(CLI::Range(0.0, 256.0))
      ->capture_default_str();
  command.add_option("--p-free", a.choice.p_free, "A cell's probability of being occupied after one silent look")
      ->check(CLI::Range(0.001, 0.499))
      ->capture_default_str();
  command.add_option("--p-occupied", a.choice.p_occupied, "The same after one echo")
      ->check(CLI::Range(0.501, 0.999))
      ->capture_default_str();
  command.add_option("--resolution", a.resolution_m, "Cells of map and truth in metres (default: the scene's)")
      ->check(above_zero());
  command.add_option("--steps", a.choice.steps, "At most so many pings")
      ->check(CLI::Range(1, 1'000'000))
      ->capture_default_str();
  command.add_option("--gate", a.gate, "YAML of bounds that the run must keep; exit code 1 where it does not");
  command.add_option("--plugin", a.plugin, "Command line of a mapper or planner of yours that speaks JSON lines");
  command.add_option("--plugin-timeout", a.plugin_timeout_s, "Seconds that it has for an answer")
      ->check(above_zero())
      ->capture_default_str();
}

void add_vehicle_options(CLI::App& command, Arguments& a) {
  Vehicle& v = a.vehicle;
  command.add_option("--start", a.start,
                     "\"x y z roll pitch yaw\" of the sonar, metres and degrees (default: the scene's first waypoint, "
                     "level); roll, pitch and depth are kept");
  command
      .add_option("--depth", a.depth_m, "Depth of the sonar in metres below the surface (default: that of the start)")
      ->check(above_zero());
  command
      .add_option("--known-free", a.known_free_m,
                  "Radius about the start that is known to be free (default: as far as the sonar is blind, and a cell)")
      ->check(above_zero());
  command.add_option("--radius", v.radius_m, "Of the vehicle, an upright cylinder about the sonar, in metres")
      ->check(above_zero())
      ->capture_default_str();
  command.add_option("--height", v.height_m, "Of the vehicle in metres")->check(above_zero())->capture_default_str();
  command.add_option("--margin", v.margin_m, "What the planner keeps off beyond the radius, in metres")
      ->check(CLI::Range(0.0, 10.0))
      ->capture_default_str();
  command.add_option("--speed", v.limits.speed_mps, "Limit in m/s")->check(above_zero())->capture_default_str();
  command.add_option("--turn-rate", a.turn_rate_degps, "Limit in degrees a second")
      ->check(above_zero())
      ->capture_default_str();
  command.add_option("--ping-rate", v.limits.ping_rate_hz, "Pings a second")
      ->check(above_zero())
      ->capture_default_str();
  command
      .add_option("--drift", a.drift_m,
                  "Dead reckoning for mapper and planner: mean error in metres after 20 minutes (default: none)")
      ->check(above_zero());
}

}  // namespace

void add_explore(CLI::App& app) {
  auto* command = app.add_subcommand("explore", "Close the loop: the map chooses where to look next, and is scored");
  auto a = std::make_shared<Arguments>();
  command->add_option("SCENE", a->scene, "Scene YAML, bundled name (see: ensonify scene list), or a mesh file")
      ->required();
  command->add_option("--out", a->out, "Folder for steps, summary, map and pictures")->required()->check(some_path());
  command->add_flag("--force", a->force, "Replace a run that is there");
  command->add_option("--sonar", a->choice.sonar, "Sonar YAML or bundled name")->capture_default_str();
  command->add_option("--range-max", a->choice.range_max_m, "End of the range window in metres")
      ->check(above_zero())
      ->capture_default_str();
  command->add_option("--range-bins", a->range_bins, "Range bins of the image, or native")
      ->check(CLI::IsMember({"native"}) | CLI::Range(1, 16384));
  command->add_option("--noise", a->choice.noise, "Noise YAML or bundled name (docs/noise.md)")->capture_default_str();
  command->add_option("--seed", a->seed, "Seed of noise and drift")->check(whole_number())->capture_default_str();
  command->add_option("--layout", a->layout, "Layout of the scene")->check(whole_number())->capture_default_str();
  add_loop_options(*command, *a);
  add_vehicle_options(*command, *a);
  command
      ->add_option("--pictures-every", a->pictures_every,
                   "Steps from one strip of pictures to the next; 0: the last only")
      ->check(CLI::Range(0, 1'000'000))
      ->capture_default_str();
  command->add_option("--jobs", a->jobs, "Threads; no result depends on it (default: all cores)")
      ->check(CLI::Range(1, 1024));
  command->add_option("--isa", a->isa, "Instruction set of the ray caster")
      ->check(CLI::IsMember({"avx2", "avx512", "sse4.2", "sse2", "auto"}));
  command->add_option("--progress", a->progress, "auto, json or none")->check(CLI::IsMember({"auto", "json", "none"}));
  command->footer(
      "Example:\n  ensonify explore test_tank --out out/explore --steps 300\n"
      "  ensonify explore pier_harbor --out out/mine --plugin \"python3 my_planner.py\" --gate gate.yaml");
  command->callback([a] { run(*a); });
}

}  // namespace ensonify::cli
