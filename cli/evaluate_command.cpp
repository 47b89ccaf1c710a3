#include <fmt/format.h>
#include <tbb/global_control.h>

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "ensonify/cli/arguments.hpp"
#include "ensonify/cli/commands.hpp"
#include "ensonify/cli/progress.hpp"
#include "ensonify/cli/report_files.hpp"
#include "ensonify/evaluation/filter_page.hpp"
#include "ensonify/generators/evaluate_filters.hpp"
#include "ensonify/generators/report_source.hpp"
#include "ensonify/generators/tune_filters.hpp"
#include "ensonify/output/atomic_file.hpp"
#include "ensonify/output/png.hpp"

namespace ensonify::cli {
namespace {

namespace fs = std::filesystem;

struct Arguments {
  std::vector<std::string> datasets;
  std::string out;
  std::vector<std::string> chains;
  std::string preset = "tuned", grid = "grid";
  EvaluateOptions options;
  bool tune = false, html = false;
  int jobs = 0;
  std::string progress = "auto";
};

void tune(const Arguments& a, const OnProgress& on_progress) {
  std::vector<Dataset> datasets;
  std::string names;
  for (const std::string& folder : a.datasets) {
    datasets.push_back(open_dataset(folder));
    names += (names.empty() ? "" : ", ") + datasets.back().name;
  }
  const auto tuned = tune_filters(datasets, load_filter_grid(a.grid), a.options, on_progress);
  std::vector<FilterStep> best;
  for (const auto& steps : tuned) {
    if (!steps.empty()) best.push_back(steps.front().step);
  }
  const std::string about =
      fmt::format("Best masks on the val split of {}, by ensonify evaluate filters --tune.", names);
  write_file(fs::path(a.out) / "tuned.yaml", preset_yaml("tuned", about, best));
  write_file(fs::path(a.out) / "tuning.csv", tuning_csv(tuned));
  fmt::print("tuned.yaml tuning.csv in {}\n", a.out);
}

void run_filters(const Arguments& a) {
  std::optional<tbb::global_control> jobs;
  if (a.jobs > 0) jobs.emplace(tbb::global_control::max_allowed_parallelism, static_cast<std::size_t>(a.jobs));
  ProgressLine progress(parse_progress_style(a.progress));
  const OnProgress on_progress = [&](const std::string& stage, int done, int total) {
    progress.show(stage, done, done, total);
  };
  if (a.tune) return tune(a, on_progress);
  if (a.datasets.size() != 1) throw ConfigError("one DATASET is evaluated at a time; several go with --tune");

  std::vector<FilterCandidate> candidates = all_candidates(load_filter_preset(a.preset));
  for (const std::string& name : a.chains) {
    FilterChain chain = find_filter(name);
    candidates.push_back({chain.name, "", std::move(chain)});
  }
  const Dataset dataset = open_dataset(a.datasets.front());
  const FilterReport report = evaluate_filters(dataset, candidates, a.options, on_progress);
  const fs::path out(a.out);
  write_file(out / "filters.csv", scores_csv(report));
  write_file(out / "filters.json", scores_json(report));
  write_file(out / "times.csv", times_csv(report));
  write_plots(out / "filters.png", scores_plots(report), a.html);
  ContactSheet frames = filter_sheet(dataset, candidates);
  write_file(out / "frames.png", encode_png(draw_contact_sheet(frames)));
  fmt::print("{}, {} frames of test, thresholds chosen on {} of val\n{}", report.dataset, report.test_frames,
             report.val_frames, scores_table(report));
  fmt::print("filters.csv filters.json times.csv filters.png frames.png in {}\n", a.out);
  if (a.html) write_report(out / "filters.html", filter_page(report, std::move(frames), report_source(dataset)));
}

void add_filters(CLI::App& evaluate) {
  auto* command = evaluate.add_subcommand("filters", "Score every filter on a dataset's test split");
  auto a = std::make_shared<Arguments>();
  command->add_option("DATASET", a->datasets, "Folder of a dataset with val and test splits; several with --tune")
      ->required()
      ->check(some_path());
  command->add_option("--out", a->out, "Folder for tables and pictures")->required()->check(some_path());
  command->add_option("--chain", a->chains, "Score this chain (YAML file or bundled name) or method too; repeat")
      ->allow_extra_args(false);
  command->add_option("--preset", a->preset, "Preset that stands beside the paper's parameters")->capture_default_str();
  auto* tune =
      command->add_flag("--tune", a->tune, "Choose parameters on the val split instead, and write them as a preset");
  command
      ->add_flag("--html", a->html,
                 "Also write filters.html: all scores and figures in one file, to look at or to send")
      ->excludes(tune);
  command->add_option("--grid", a->grid, "With --tune: the values to try")->capture_default_str();
  command
      ->add_option("--max-frames", a->options.max_frames, "At most so many frames of a split, spread over its places")
      ->check(CLI::Range(1, 100'000'000));
  command->add_option("--jobs", a->jobs, "Threads; the scores do not depend on it (default: all cores)")
      ->check(CLI::Range(1, 1024));
  command->add_option("--progress", a->progress, "auto, json or none")->check(CLI::IsMember({"auto", "json", "none"}));
  command->footer(
      "Example:\n  ensonify evaluate filters out/quick --out out/filters\n"
      "  ensonify evaluate filters out/quick --out out/mine --tune");
  command->callback([a] { run_filters(*a); });
}

}  // namespace

void add_evaluate(CLI::App& app) {
  auto* command = app.add_subcommand("evaluate", "Score filters and maps against a dataset's truth");
  command->require_subcommand(1);
  command->footer("Example:\n  ensonify evaluate filters out/quick --out out/filters");
  add_filters(*command);
  add_evaluate_map(*command);
}

}  // namespace ensonify::cli
