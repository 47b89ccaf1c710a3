#include <fmt/format.h>
#include <fmt/ostream.h>
#include <tbb/global_control.h>

#include <cmath>
#include <iostream>
#include <memory>
#include <optional>
#include <string>

#include "ensonify/cli/arguments.hpp"
#include "ensonify/cli/commands.hpp"
#include "ensonify/cli/progress.hpp"
#include "ensonify/cli/signals.hpp"
#include "ensonify/core/available_memory.hpp"
#include "ensonify/core/error.hpp"
#include "ensonify/generators/make_map.hpp"
#include "ensonify/output/map_files.hpp"

namespace ensonify::cli {
namespace {

struct Arguments {
  std::string dataset, filter = "none", preset, model = "points", poses = "true", out;
  MapRequest request;
  std::optional<double> slice_z_m;
  bool no_post = false;
  int jobs = 0;
  std::string progress = "auto";
};

/// Why a map has no free cells, or no occupied ones: seldom what was wanted.
const char* likely_cause(std::size_t occupied, std::size_t free, const Arguments& a) {
  if (occupied == 0 && free == 0) return "no ping reaches into its box";
  if (occupied == 0) return "no pixel echoes; try a lower --threshold";
  if (a.request.threshold <= 0.0) return "at --threshold 0 every pixel echoes";
  if (!a.no_post) return "equalisation after the filter lifts dark water too; try --no-post, or a higher --threshold";
  return "every pixel that was looked at echoes; try a higher --threshold";
}

void print_cells(const MadeMap& made, const Arguments& a) {
  const GridFrame& frame = made.map.frame;
  std::size_t occupied = 0;
  std::size_t free = 0;
  for (const float value : made.map.log_odds) {
    occupied += value > 0;
    free += value < 0;
  }
  fmt::print("{}: {} frames{}, {} x {} x {} cells of {} m{}: {} occupied, {} free, {} unknown -> {}\n", made.place,
             made.frames, made.ordered ? "" : " (random poses: in no order, which maps do not need)", frame.size[0],
             frame.size[1], frame.size[2], frame.resolution_m, made.as_truth ? " in the box of the truth grid" : "",
             occupied, free, frame.cells() - occupied - free, a.out);
  if (occupied == 0 || free == 0) {
    fmt::print(std::cerr, "ensonify: warning: the map has no {} cell: {}\n", free == 0 ? "free" : "occupied",
               likely_cause(occupied, free, a));
  }
}

void run(const Arguments& a) {
  std::optional<tbb::global_control> jobs;
  if (a.jobs > 0) jobs.emplace(tbb::global_control::max_allowed_parallelism, static_cast<std::size_t>(a.jobs));
  const std::filesystem::path out(a.out);
  require_map_format(out);
  if (a.slice_z_m && out.extension() != ".pgm") throw ConfigError("--slice-z goes with an output of .pgm");
  MapRequest request = a.request;
  request.filter = find_map_filter(a.filter, a.preset, !a.no_post);
  request.model = inverse_model_named(a.model);
  request.poses = a.poses == "true" ? MapPoses::truth : MapPoses::drifted;
  request.file = out;
  request.memory_bytes = static_cast<double>(available_memory_bytes());
  const Dataset dataset = open_dataset(a.dataset);
  ProgressLine progress(parse_progress_style(a.progress));
  const MadeMap made = make_map(dataset, request, [&](const std::string& stage, int done, int total) {
    progress.show(stage, done, done, total);
  });
  write_unbroken(out.parent_path(), [&] { write_map(made.map, out, a.slice_z_m); });
  print_cells(made, a);
}

}  // namespace

void add_map(CLI::App& app) {
  auto* command = app.add_subcommand("map", "Occupancy map from the frames of one place of a dataset");
  auto a = std::make_shared<Arguments>();
  MapRequest& request = a->request;
  command->add_option("DATASET", a->dataset, "Folder of a dataset")->required()->check(some_path());
  command->add_option("--out", a->out, "File: .npz, .bt or .ot (OctoMap), .pgm (nav2, with .yaml) or .ply")
      ->required()
      ->check(some_path());
  command
      ->add_option("--filter", a->filter,
                   "none, clean, truth_mask (raw where the true mask is set), a method, or a chain's YAML or name")
      ->capture_default_str();
  command->add_option("--preset", a->preset, "Parameters chosen for the method: paper, tuned, or a YAML file");
  command->add_flag("--no-post", a->no_post, "Without the unsharp filter and histogram equalisation after the filter");
  command->add_option("--threshold", request.threshold, "Grey level from which a pixel echoes")
      ->check(CLI::Range(0.0, 256.0))
      ->capture_default_str();
  command->add_option("--model", a->model, "points, arc, arc_shadow, carve, or oracle (needs truth: true)")
      ->capture_default_str();
  command->add_option("--resolution", request.resolution_m, "Edge of a cell in metres (default: the truth grid's)")
      ->check(above_zero());
  command->add_option("--split", request.split, "train, val or test")->capture_default_str();
  command->add_option("--scene", request.place, "Place, as metadata.jsonl names it (default: the split's only one)");
  command->add_option("--poses", a->poses, "true, or drifted as dead reckoning believes them")
      ->check(CLI::IsMember({"true", "drifted"}))
      ->capture_default_str();
  command->add_option("--slice-z", a->slice_z_m, ".pgm: height of the slice in metres (default: middle of the map)");
  command->add_option("--max-frames", request.max_frames, "At most so many frames, evenly spread")
      ->check(CLI::Range(1, 100'000'000));
  command->add_option("--jobs", a->jobs, "Threads; the map does not depend on it (default: all cores)")
      ->check(CLI::Range(1, 1024));
  command->add_option("--progress", a->progress, "auto, json or none")->check(CLI::IsMember({"auto", "json", "none"}));
  command->footer(
      "Example:\n  ensonify map out/quick --scene test_tank --filter wavelet --no-post --threshold 30 --model carve "
      "--out out/tank.bt");
  command->callback([a] { run(*a); });
}

}  // namespace ensonify::cli
