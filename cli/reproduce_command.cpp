#include <fmt/format.h>
#include <tbb/global_control.h>

#include <filesystem>
#include <memory>
#include <optional>
#include <string>

#include "ensonify/cli/arguments.hpp"
#include "ensonify/cli/commands.hpp"
#include "ensonify/cli/progress.hpp"
#include "ensonify/cli/report_files.hpp"
#include "ensonify/reproduction/conclusions.hpp"
#include "ensonify/reproduction/numbers.hpp"
#include "ensonify/reproduction/page.hpp"
#include "ensonify/reproduction/reproduce.hpp"

namespace ensonify::cli {
namespace {

struct Arguments {
  std::string out, scale = "quick", data, models, real, progress = "auto";
  int jobs = 0;
};

std::optional<std::filesystem::path> named(const std::string& path) {
  return path.empty() ? std::nullopt : std::optional<std::filesystem::path>(path);
}

void run(const Arguments& a) {
  std::optional<tbb::global_control> jobs;
  if (a.jobs > 0) jobs.emplace(tbb::global_control::max_allowed_parallelism, static_cast<std::size_t>(a.jobs));
  ProgressLine progress(parse_progress_style(a.progress));
  ReproduceOptions options{a.out, a.scale, named(a.data), named(a.models), named(a.real)};
  options.on_progress = [&](const std::string& stage, int done, int total) { progress.show(stage, done, done, total); };
  const Findings found = reproduce(options);
  write_numbers(found, options.out / "numbers");
  for (const Conclusion& c : conclusions_of(found)) fmt::print("{:<14} {}\n", words(c.verdict), c.claim);
  for (const Missing& lack : found.missing) fmt::print("{:<14} {}: {}\n", "missing", lack.what, lack.why);
  write_report(options.out / "report.html", page_of(found));
}

}  // namespace

void add_reproduce(CLI::App& app) {
  auto* command = app.add_subcommand("reproduce", "Make the tables and figures of Lin et al. (ICRA 2023) from nothing");
  auto a = std::make_shared<Arguments>();
  command->add_option("--out", a->out, "Folder for the data, the numbers and report.html; the same again goes on")
      ->required()
      ->check(some_path());
  command->add_option("--scale", a->scale, "quick: a tenth of the frames, minutes; full: all of them")
      ->check(CLI::IsMember({"quick", "full"}))
      ->capture_default_str();
  command->add_option("--data", a->data, "A dataset of yours in place of the paper's; what it lacks is left out");
  command->add_option("--models", a->models,
                      "Folder of networks from few pairs, as scripts/train_models makes them (default: the bundled)");
  command->add_option("--real", a->real, "Folder of raw pings of a real sonar (PNG), to stand beside simulated ones");
  command->add_option("--jobs", a->jobs, "Threads; no number but times depends on it (default: all cores)")
      ->check(CLI::Range(1, 1024));
  command->add_option("--progress", a->progress, "auto, json or none")->check(CLI::IsMember({"auto", "json", "none"}));
  command->footer("Example:\n  ensonify reproduce --scale quick --out out/paper_report");
  command->callback([a] { run(*a); });
}

}  // namespace ensonify::cli
