#include <fmt/format.h>
#include <tbb/global_control.h>

#include <filesystem>
#include <memory>
#include <optional>

#include "ensonify/cli/against_command.hpp"
#include "ensonify/cli/arguments.hpp"
#include "ensonify/cli/commands.hpp"
#include "ensonify/cli/progress.hpp"
#include "ensonify/cli/report_files.hpp"
#include "ensonify/generators/even_tiles.hpp"
#include "ensonify/generators/report_source.hpp"
#include "ensonify/generators/stats_json.hpp"
#include "ensonify/generators/stats_page.hpp"
#include "ensonify/generators/stats_plots.hpp"
#include "ensonify/output/atomic_file.hpp"
#include "ensonify/output/png.hpp"

namespace ensonify::cli {
namespace {

struct Arguments {
  std::string folder;
  std::string against, split = "test";
  std::vector<std::string> regions;
  std::string out;
  StatsOptions options;
  int jobs = 0;
  double least_level = default_least_level;
  bool json = false, html = false;
  std::string progress = "auto";
};

void print_summary(const DatasetStats& stats) {
  fmt::print("{}: {}\n  split         frames     read   mask share: 5 %   median     95 %   without echo\n", stats.name,
             stats.title);
  const auto line = [](const std::string& name, const Figures& f) {
    fmt::print("  {:<10} {:9} {:8} {:18.4f} {:8.4f} {:8.4f} {:14.4f}\n", name, f.frames, f.frames_read,
               f.mask_share_percentiles[1], f.mask_share_percentiles[3], f.mask_share_percentiles[5],
               f.frames_read > 0 ? static_cast<double>(f.pixels.without_echo) / f.frames_read : 0.0);
  };
  for (const auto& [split, figures] : stats.splits) line(split, figures);
  line("all", stats.overall);
  for (const PlaceFigures& place : stats.places) {
    if (place.figures.frames == 0) fmt::print("  never seen: {} ({})\n", place.place.name, place.split);
  }
  if (!stats.variety) return;
  const Variety& v = stats.variety->variety;
  fmt::print("  nearly equal pairs in train: {}{}, {} of {} frames in one; {} blank frames\n",
             v.complete ? "" : "more than ", v.pairs, v.frames_in_pairs, v.frames, v.blank);
}

void run(const Arguments& a) {
  std::optional<tbb::global_control> jobs;
  if (a.jobs > 0) jobs.emplace(tbb::global_control::max_allowed_parallelism, static_cast<std::size_t>(a.jobs));
  if (!a.against.empty()) {
    return run_against(
        {a.folder, a.against, a.out, a.split, a.regions, a.options.max_frames, a.least_level, a.json, a.progress});
  }
  ProgressLine progress(parse_progress_style(a.progress));
  const auto on_progress = [&](int done, int total) { progress.show("stats", done, done, total); };
  const Dataset dataset = open_dataset(a.folder);
  const DatasetStats stats = dataset_stats(dataset, a.options, on_progress);
  const std::string json = stats_json(stats);
  if (a.json) {
    fmt::print("{}", json);
    return;
  }
  const std::filesystem::path out =
      a.out.empty() ? std::filesystem::path(a.folder) / "stats" : std::filesystem::path(a.out);
  write_file(out / "stats.json", json);
  write_plots(out / "stats.png", stats_plots(stats), a.html);
  for (const auto& [split, sheet] : stats.contact_sheets) {
    write_file(out / fmt::format("contact_{}.png", split), encode_png(draw_contact_sheet(sheet)));
  }
  print_summary(stats);
  fmt::print("stats.json stats.png contact_*.png in {}\n", out.string());
  if (a.html) write_report(out / "stats.html", stats_page(stats, report_source(dataset)));
}

}  // namespace

void add_stats(CLI::App& app) {
  auto* command = app.add_subcommand("stats", "Describe a dataset: shares, levels, ranges, poses, nearly equal frames");
  auto a = std::make_shared<Arguments>();
  command->add_option("DIR", a->folder, "Folder of the dataset; with --against also one of PNG images")
      ->required()
      ->check(some_path());
  auto* against = command->add_option(
      "--against", a->against, "Folder of real images (grey PNG, rows = range): measure speckle and levels of both");
  against->check(some_path());
  command->add_option("--split", a->split, "With --against: split of the dataset whose raw images are measured")
      ->capture_default_str()
      ->needs(against);
  command
      ->add_option("--region", a->regions,
                   "With --against: \"[name=]row0 row1 column0 column1\", measured by itself in all images; repeat")
      ->allow_extra_args(false)
      ->needs(against);
  command->add_option("--least-level", a->least_level, "With --against: least mean grey level of an even tile")
      ->check(CLI::Range(0.0, 255.0))
      ->capture_default_str()
      ->needs(against);
  command->add_option("--out", a->out, "Folder for what is written (default: DIR/stats)")->check(some_path());
  command
      ->add_option("--max-frames", a->options.max_frames,
                   "Read at most this many frames, spread evenly (with --against: images of a side, default 64)")
      ->check(CLI::Range(1, 100'000'000));
  command->add_option("--columns", a->options.contact_columns, "Frames of a place on the contact sheets")
      ->check(CLI::Range(1, 64))
      ->excludes(against);
  command->add_option("--jobs", a->jobs, "Threads; the result does not depend on it (default: all cores)")
      ->check(CLI::Range(1, 1024));
  auto* json = command->add_flag("--json", a->json, "Print stats.json (against.json) and write nothing");
  command
      ->add_flag("--html", a->html, "Also write stats.html: all figures and tables in one file, to look at or to send")
      ->excludes(json)
      ->excludes(against);
  command->add_option("--progress", a->progress, "auto, json or none")->check(CLI::IsMember({"auto", "json", "none"}));
  command->footer(
      "Example:\n  ensonify stats out/quick\n  ensonify stats out/paper --max-frames 1000 --out out/look\n"
      "  ensonify stats out/quick --against real_pings");
  command->callback([a] { run(*a); });
}

}  // namespace ensonify::cli
