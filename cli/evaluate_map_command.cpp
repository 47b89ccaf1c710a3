#include <fmt/format.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "ensonify/cli/arguments.hpp"
#include "ensonify/cli/commands.hpp"
#include "ensonify/cli/progress.hpp"
#include "ensonify/cli/report_files.hpp"
#include "ensonify/core/available_memory.hpp"
#include "ensonify/evaluation/map_page.hpp"
#include "ensonify/generators/evaluate_maps.hpp"
#include "ensonify/generators/report_source.hpp"
#include "ensonify/mapping/inverse_model.hpp"
#include "ensonify/output/atomic_file.hpp"
#include "ensonify/output/png.hpp"

namespace ensonify::cli {
namespace {

namespace fs = std::filesystem;

struct Arguments {
  std::string dataset, out, preset, poses = "true";
  std::vector<std::string> filters{"raw", "wavelet", "lee_enhanced", "truth_mask", "clean"};
  std::vector<int> tolerances{1};
  MapEvaluation what;
  bool no_post = false, html = false;
  int jobs = 0;
  std::string progress = "auto";
};

MapEvaluation evaluation_of(const Arguments& a) {
  MapEvaluation what = a.what;
  for (const std::string& name : a.filters) what.filters.push_back(find_map_filter(name, a.preset, !a.no_post));
  for (const std::string& model : what.models) inverse_model_named(model);
  if (a.poses == "both") what.poses = {MapPoses::truth, MapPoses::drifted};
  if (a.poses == "drifted") what.poses = {MapPoses::drifted};
  what.tolerances = a.tolerances;
  what.tolerances.push_back(0);
  std::ranges::sort(what.tolerances);
  what.tolerances.erase(std::unique(what.tolerances.begin(), what.tolerances.end()), what.tolerances.end());
  what.memory_bytes = static_cast<double>(available_memory_bytes());
  return what;
}

void run(const Arguments& a) {
  std::optional<tbb::global_control> jobs;
  if (a.jobs > 0) jobs.emplace(tbb::global_control::max_allowed_parallelism, static_cast<std::size_t>(a.jobs));
  const MapEvaluation what = evaluation_of(a);
  const Dataset dataset = open_dataset(a.dataset);
  ProgressLine progress(parse_progress_style(a.progress));
  const MapEvaluationResult result = evaluate_maps(
      dataset, what, [&](const std::string& stage, int done, int total) { progress.show(stage, done, done, total); });

  const fs::path out(a.out);
  const MapReport& report = result.report;
  write_file(out / "map.csv", map_scores_csv(report));
  write_file(out / "summary.csv", map_summary_csv(report));
  write_file(out / "map.json", map_scores_json(report));
  for (const char* poses : {"true", "drifted"}) {
    if (!std::ranges::any_of(report.curves, [&](const MapCurve& c) { return c.poses == poses; })) continue;
    write_plots(out / fmt::format("curves_{}.png", poses), map_plots(report, "all", poses), a.html);
    for (const auto& [place, sheet] : result.pictures) {
      write_plots(out / fmt::format("curves_{}_{}.png", place, poses), map_plots(report, place, poses), a.html);
    }
  }
  for (const auto& [place, sheet] : result.pictures) {
    write_file(out / fmt::format("maps_{}.png", place), encode_png(draw_contact_sheet(sheet)));
  }
  fmt::print("{}, split {}, all places, at the threshold with the best F1\n{}", report.dataset, report.split,
             map_table(report));
  fmt::print("map.csv summary.csv map.json curves_*.png maps_*.png in {}\n", a.out);
  if (a.html) write_report(out / "map.html", map_page(report, result.pictures, report_source(dataset)));
}

}  // namespace

void add_evaluate_map(CLI::App& evaluate_command) {
  auto* command = evaluate_command.add_subcommand("map", "Score occupancy maps of every filter, model and threshold");
  auto a = std::make_shared<Arguments>();
  command->add_option("DATASET", a->dataset, "Folder of a dataset with grids")->required()->check(some_path());
  command->add_option("--out", a->out, "Folder for tables and pictures")->required()->check(some_path());
  command->add_option("--filter", a->filters, "As in ensonify map; repeat")
      ->allow_extra_args(false)
      ->capture_default_str();
  command
      ->add_option("--model", a->what.models, "points, arc, arc_shadow, carve, oracle; repeat (default: all that can)")
      ->allow_extra_args(false);
  command->add_option("--preset", a->preset, "Parameters chosen for methods: paper, tuned, or a YAML file");
  command->add_flag("--no-post", a->no_post, "Without the unsharp filter and histogram equalisation after the filter");
  command->add_option("--threshold-max", a->what.threshold_max, "Thresholds 0, 1 and so on up to this grey level")
      ->check(CLI::Range(0, 253))
      ->capture_default_str();
  command->add_option("--poses", a->poses, "true, drifted, or both: then with the loss under drift")
      ->check(CLI::IsMember({"true", "drifted", "both"}))
      ->capture_default_str();
  command->add_option("--tolerance", a->tolerances, "Cells that a surface may lie aside; 0 is always there; repeat")
      ->allow_extra_args(false)
      ->check(CLI::Range(0, 1000))
      ->capture_default_str();
  command->add_option("--split", a->what.split, "train, val or test")->capture_default_str();
  command->add_option("--max-frames", a->what.max_frames, "At most so many frames of a place, evenly spread")
      ->check(CLI::Range(1, 100'000'000));
  command->add_flag("--html", a->html,
                    "Also write map.html: all scores, curves and maps in one file, to look at or to send");
  command->add_option("--jobs", a->jobs, "Threads; the scores do not depend on it (default: all cores)")
      ->check(CLI::Range(1, 1024));
  command->add_option("--progress", a->progress, "auto, json or none")->check(CLI::IsMember({"auto", "json", "none"}));
  command->footer("Example:\n  ensonify evaluate map out/quick --out out/maps --filter clean --poses both");
  command->callback([a] { run(*a); });
}

}  // namespace ensonify::cli
