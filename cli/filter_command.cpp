#include <fmt/format.h>
#include <fmt/ranges.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <filesystem>
#include <memory>
#include <mutex>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "ensonify/cli/arguments.hpp"
#include "ensonify/cli/commands.hpp"
#include "ensonify/cli/progress.hpp"
#include "ensonify/cli/signals.hpp"
#include "ensonify/cli/streams.hpp"
#include "ensonify/config/library.hpp"
#include "ensonify/core/error.hpp"
#include "ensonify/core/parallel.hpp"
#include "ensonify/filters/filter_chain.hpp"
#include "ensonify/filters/filter_registry.hpp"
#include "ensonify/output/atomic_file.hpp"
#include "ensonify/output/fan_view.hpp"
#include "ensonify/output/grey_file.hpp"
#include "ensonify/sensor_models/sonar_model.hpp"

namespace ensonify::cli {
namespace {

namespace fs = std::filesystem;

struct Arguments {
  std::string method, input, output;
  std::vector<std::string> settings;
  std::string preset, format;
  std::string fan;  // sonar of the fan images, empty: images are polar
  double range_max_m = 0;
  int jobs = 0;
  bool list = false, markdown = false;
  std::string progress = "auto";
};

constexpr const char* role_title(FilterRole role) {
  switch (role) {
    case FilterRole::despeckles:
      return "Despecklers: grey image -> grey image";
    case FilterRole::detects:
      return "Detectors: grey image -> mask of 0 and 255";
    case FilterRole::finishes:
      return "Steps after them";
  }
  return "";
}

void print_methods() {
  std::optional<FilterRole> role;
  for (const MethodInfo& method : filter_methods()) {
    if (role != method.role) fmt::print("{}{}\n", role ? "\n" : "", role_title(method.role));
    role = method.role;
    fmt::print("  {:<16}{}\n", method.name, method.source);
    for (const ParameterInfo& p : method.parameters) {
      fmt::print("    {:<14}{:<16} {}{}; {}\n", p.name, p.otherwise, p.about, p.unit.empty() ? "" : " [" + p.unit + "]",
                 p.rule);
    }
  }
  fmt::print("\nChains: {}\nPresets: {}\n", fmt::join(library_names("filters"), " "),
             fmt::join(library_names("filters/presets"), " "));
}

void print_markdown() {
  fmt::print("| method | parameter | default | unit | values | meaning |\n|---|---|---|---|---|---|\n");
  for (const MethodInfo& method : filter_methods()) {
    fmt::print("| **`{}`** | | | | | {} |\n", method.name, method.source);
    for (const ParameterInfo& p : method.parameters) {
      fmt::print("| | `{}` | {} | {} | {} | {} |\n", p.name, p.otherwise, p.unit, p.rule, p.about);
    }
  }
}

FilterChain chosen_chain(const Arguments& a) {
  FilterChain chain = find_filter(a.method);
  const bool method = chain.steps.size() == 1 && chain.name == name_of(chain.steps[0].method);
  if (!method && !(a.settings.empty() && a.preset.empty())) {
    throw ConfigError(
        fmt::format("--set and --preset go with a method; {} is a chain, which holds its parameters", a.method));
  }
  if (!a.preset.empty()) {
    const FilterPreset preset = load_filter_preset(a.preset);
    if (const auto found = preset.methods.find(chain.name); found != preset.methods.end())
      chain.steps[0] = found->second;
  }
  std::set<std::string> assigned;
  for (const std::string& setting : a.settings) {
    const std::string key = setting.substr(0, setting.find('='));
    if (!assigned.insert(key).second) throw ConfigError(fmt::format("--set {}: is given twice; keep one", key));
    assign_parameter(chain.steps[0], setting);
  }
  for (const FilterStep& step : chain.steps) check_filter(step);
  return chain;
}

/// What is done with an image: the chain, on range bins and beams, whatever the image shows.
struct Work {
  FilterChain chain;
  std::optional<SonarGeometry> fan;

  GreyImage of(const GreyImage& raw) const {
    if (!fan) return apply(chain, raw);
    const GreyImage filtered = apply(chain, {polar_view(raw.grey, *fan), raw.depth});
    const bool mask = role_of(chain.steps.back().method) == FilterRole::detects;
    return {fan_view(filtered.grey, *fan, raw.grey.rows(), mask ? Resampling::nearest : Resampling::bilinear),
            raw.depth};
  }
};

Work chosen_work(const Arguments& a) {
  Work work{chosen_chain(a), {}};
  if (a.fan.empty()) {
    if (a.range_max_m > 0) throw ConfigError("--range-max goes with --fan, whose scale it is");
    return work;
  }
  RangeWindow window;
  if (a.range_max_m > 0) window.range_max_m = a.range_max_m;
  work.fan = open_sonar(a.fan, window).geometry;
  return work;
}

void filter_file(const Work& work, const fs::path& input, const fs::path& output) {
  const GreyImage raw = read_grey(input);
  GreyImage filtered;
  try {
    filtered = work.of(raw);
  } catch (const DataError& e) {
    throw DataError(fmt::format("{}: {}", input.string(), e.what()));
  }
  filtered.depth = raw.depth;
  write_grey(output, filtered);
}

/// Files that went wrong do not keep the others from being filtered.
void filter_folder(const Work& work, const Arguments& a) {
  std::vector<fs::path> inputs;
  for (const auto& entry : fs::directory_iterator(a.input)) {
    if (is_grey_file(entry.path()) && entry.path().filename().string()[0] != '.') inputs.push_back(entry.path());
  }
  if (inputs.empty()) throw DataError(fmt::format("{}: no .png, .exr or .npy file in this folder", a.input));
  std::ranges::sort(inputs);
  const fs::path folder(a.output);
  fs::create_directories(folder);
  if (fs::equivalent(folder, a.input)) throw ConfigError(fmt::format("{}: would overwrite its own input", a.output));
  remove_abandoned_beside(folder);

  watch_signals();
  ProgressLine progress(parse_progress_style(a.progress));
  std::mutex mutex;
  int done = 0;
  std::vector<std::string> faults(inputs.size());
  const int total = static_cast<int>(inputs.size());
  parallel_for(total, [&](int i) {
    if (caught_signal() != 0) return;
    fs::path output = folder / inputs[i].filename();
    if (!a.format.empty()) output.replace_extension(a.format);
    try {
      filter_file(work, inputs[i], output);
    } catch (const Error& e) {
      faults[i] = e.what();
    }
    const std::lock_guard lock(mutex);
    ++done;
    progress.show("filter", done, done, total);
  });
  if (caught_signal() != 0) throw ExitCode{128 + caught_signal()};
  std::erase_if(faults, [](const std::string& fault) { return fault.empty(); });
  for (const std::string& fault : faults) complain(fault);
  fmt::print("{} of {} images filtered into {}\n", inputs.size() - faults.size(), inputs.size(), a.output);
  if (!faults.empty()) throw ExitCode{1};
}

void run(const Arguments& a) {
  if (a.list) return a.markdown ? print_markdown() : print_methods();
  if (a.method.empty() || a.input.empty() || a.output.empty()) {
    throw ConfigError("METHOD, INPUT and OUTPUT are needed; ensonify filter --list shows the methods");
  }
  std::optional<tbb::global_control> jobs;
  if (a.jobs > 0) jobs.emplace(tbb::global_control::max_allowed_parallelism, static_cast<std::size_t>(a.jobs));
  const Work work = chosen_work(a);
  if (!fs::exists(a.input)) throw DataError(fmt::format("{}: there is no such file or folder", a.input));
  if (fs::is_directory(a.input)) return filter_folder(work, a);
  if (!a.format.empty()) throw ConfigError("--format goes with a folder; a file's format is its extension");
  const fs::path output =
      fs::is_directory(a.output) ? fs::path(a.output) / fs::path(a.input).filename() : fs::path(a.output);
  if (!is_grey_file(output))
    throw ConfigError(fmt::format("{}: an image must end in .png, .exr or .npy", output.string()));
  std::error_code no_throw;
  if (fs::equivalent(a.input, output, no_throw)) {
    throw ConfigError(fmt::format("{}: would overwrite its own input; name another file", output.string()));
  }
  write_unbroken(output.parent_path(), [&] { filter_file(work, a.input, output); });
}

}  // namespace

void add_filter(CLI::App& app) {
  auto* command = app.add_subcommand("filter", "Despeckle or mask an image or a folder of images");
  auto a = std::make_shared<Arguments>();
  command->add_option("METHOD", a->method, "A method of --list, a chain's YAML file, or a bundled chain");
  command->add_option("INPUT", a->input, "Image (.png of 8 or 16 bits, .npy, .exr of one channel) or a folder of them");
  command->add_option("OUTPUT", a->output, "Image or folder; .npy and .exr hold levels of 0..255 unrounded");
  command->add_option("--set", a->settings, "Parameter of the method, key=value; repeat")->allow_extra_args(false);
  command->add_option("--preset", a->preset, "Parameters chosen for the method: paper, tuned, or a YAML file");
  command->add_option(
      "--fan", a->fan,
      "Sonar YAML or bundled name: images are fans, forward up, the sonar at the middle of the lower edge; "
      "filtered as range bins and beams, and drawn again");
  command->add_option("--range-max", a->range_max_m, "With --fan: metres from the lower to the upper edge of the fan")
      ->check(above_zero());
  command->add_option("--format", a->format, "Of a folder's outputs: png, npy or exr (default: as the input)")
      ->check(CLI::IsMember({"png", "npy", "exr"}));
  command->add_flag("--list", a->list,
                    "Every method with its parameters, defaults, units and sources; the bundled chains and presets");
  command->add_flag("--markdown", a->markdown, "With --list: as a table");
  command->add_option("--jobs", a->jobs, "Threads for a folder (default: all cores)")->check(CLI::Range(1, 1024));
  command->add_option("--progress", a->progress, "auto, json or none")->check(CLI::IsMember({"auto", "json", "none"}));
  command->footer(
      "Example:\n  ensonify filter lee_enhanced out/ping/raw.png out/ping/lee.png --set window=7 --set cu=0.52\n"
      "  ensonify filter wavelet out/quick/test/raw out/wavelet --preset tuned");
  command->callback([a] { run(*a); });
}

}  // namespace ensonify::cli
