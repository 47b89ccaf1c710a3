#include "ensonify/generators/generate.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <exception>
#include <mutex>
#include <nlohmann/json.hpp>

#include "ensonify/core/error.hpp"
#include "ensonify/core/parallel.hpp"
#include "ensonify/generators/finish_dataset.hpp"
#include "ensonify/generators/lost_files.hpp"
#include "ensonify/generators/write_block.hpp"
#include "ensonify/output/atomic_file.hpp"
#include "ensonify/scenes/scene.hpp"

namespace ensonify {
namespace {

/// A broken scene or a trajectory into a wall is a mistake in the configuration: found before anything is written, so
/// that the corrected one may use the folder. A place that is swum is built for it, and kept. Of the others only the
/// recipe's own scenes are read: bundled ones are known to be whole, and places are best built while frames are made.
void check_places(const FrameMaker& maker, const GenerateOptions& options) {
  struct Check {
    int place;
    const PlaceRef* ref;
    bool swum;
  };
  std::vector<Check> checks;
  int place = 0;
  for (const Split& split : maker.recipe().splits) {
    const bool swum = std::holds_alternative<TrajectoryPoses>(split.poses);
    for (const PlaceRef& ref : split.places) {
      std::error_code no_throw;
      if (swum || std::filesystem::is_regular_file(ref.scene, no_throw)) checks.push_back({place, &ref, swum});
      ++place;
    }
  }
  // Of several mistakes the first is reported, whichever thread is faster.
  std::vector<std::exception_ptr> mistakes(checks.size());
  std::mutex mutex;
  Progress progress{.total = static_cast<int>(checks.size()), .stage = "places"};
  parallel_for(progress.total, [&](int i) {
    const Check& check = checks[static_cast<std::size_t>(i)];
    if (options.stopped()) return;
    try {
      if (check.swum)
        maker.check_trajectory(check.place);
      else
        load_scene(check.ref->scene, check.ref->layout);
    } catch (...) {
      mistakes[static_cast<std::size_t>(i)] = std::current_exception();
    }
    const std::scoped_lock guard(mutex);
    progress.fresh = ++progress.done;
    options.on_progress(progress);
  });
  for (const std::exception_ptr& mistake : mistakes) {
    if (mistake) std::rethrow_exception(mistake);
  }
}

[[noreturn]] void refuse_lost_files(const DatasetPaths& paths) {
  throw DiskError(
      fmt::format("{}: files that this run wrote are gone: someone clears the folder; run again", paths.root.string()));
}

/// A folder that is removed meanwhile would be made again by the next file, and hold a part of the set for ever.
void check_folder(const DatasetPaths& paths) {
  std::error_code no_throw;
  if (!std::filesystem::is_regular_file(paths.plan(), no_throw)) refuse_lost_files(paths);
}

struct Failure {
  int block;
  std::string reason;
};

std::filesystem::path failures_file(const DatasetPaths& paths) { return paths.state() / "failed.jsonl"; }

void report_failures(const DatasetPaths& paths, std::vector<Failure> failures) {
  std::sort(failures.begin(), failures.end(), [](const Failure& a, const Failure& b) { return a.block < b.block; });
  std::string lines;
  for (const Failure& f : failures) {
    lines += nlohmann::json{{"block", f.block}, {"reason", f.reason}}.dump() + "\n";
  }
  const auto file = failures_file(paths);
  write_file(file, lines);
  throw DataError(fmt::format("{} blocks could not be made, listed in {}; the first: {}", failures.size(),
                              file.string(), failures.front().reason));
}

}  // namespace

std::string command_line_of(const std::string& recipe_source, const Recipe& recipe, const std::string& isa,
                            SampleFormat format, int pairs) {
  std::string line = fmt::format("ensonify generate {} --seed {} --isa {} --format {}", recipe_source, recipe.seed, isa,
                                 format == SampleFormat::folder ? "folder" : "webdataset");
  if (pairs > 0) line += fmt::format(" --pairs {}", pairs);
  return line + " --out DIR";
}

Outcome generate(const Recipe& recipe, const GenerateOptions& options) {
  FrameMaker maker(recipe, options.isa);
  if (recipe.cell_truth && options.format == SampleFormat::webdataset) {
    throw ConfigError("truth: true writes EXR files, which WebDataset shards do not hold; use --format folder");
  }
  const DatasetPaths paths{options.out};
  const std::string plan = plan_json(maker, options.isa, options.format);
  check_folder_for(paths, plan, options.force);
  if (!is_complete(paths, plan)) check_places(maker, options);
  if (options.stopped()) return Outcome::stopped;
  const FolderLock in_use = prepare_dataset(paths, plan, options.force);
  std::error_code no_throw;
  const std::vector<Block> blocks = plan_blocks(recipe, options.format);
  if (std::filesystem::is_regular_file(paths.manifest(), no_throw)) {
    const std::optional<std::string> lost = lost_file(paths, blocks);
    if (!lost) return Outcome::complete;
    options.on_lost(*lost);
    std::filesystem::remove(paths.manifest(), no_throw);  // until they are made again, the set is not complete
  }

  std::vector<Block> missing;
  Progress progress;
  for (const Block& block : blocks) {
    if (block.index % options.shards != options.shard) continue;
    progress.total += block.frames;
    if (is_done(paths, block))
      progress.done += block.frames;
    else
      missing.push_back(block);
  }
  options.on_progress(progress);

  std::mutex mutex;
  std::vector<Failure> failures;
  std::atomic<bool> stopped = false;
  const auto after_frame = [&] {
    check_folder(paths);
    const std::scoped_lock guard(mutex);
    ++progress.done;
    ++progress.fresh;
    options.on_progress(progress);
    if (options.stopped()) stopped = true;
    return !stopped;
  };
  parallel_for(static_cast<int>(missing.size()), [&](int i) {
    if (stopped) return;
    try {
      write_block(maker, paths, missing[static_cast<std::size_t>(i)], options.format, after_frame);
    } catch (const DiskError&) {
      stopped = true;  // no other frame would fare better
      throw;
    } catch (const DataError& e) {
      const std::scoped_lock lock(mutex);
      failures.push_back({missing[static_cast<std::size_t>(i)].index, e.what()});
    }
  });
  if (!failures.empty()) report_failures(paths, std::move(failures));
  std::filesystem::remove(failures_file(paths), no_throw);  // of an earlier run
  if (stopped) return Outcome::stopped;
  bool all_done = true;
  for (const Block& block : blocks) {
    if (is_done(paths, block)) continue;
    if (block.index % options.shards == options.shard) refuse_lost_files(paths);
    all_done = false;
  }
  if (!all_done) return Outcome::shard_done;
  maker.end_pings();
  return finish_dataset(maker, paths, blocks, options) ? Outcome::complete : Outcome::stopped;
}

std::string generate_only(const Recipe& recipe, const GenerateOptions& options, int index) {
  if (index < 0 || index >= recipe.frames()) {
    throw ConfigError(fmt::format("--only {}: the recipe has frames 0 to {}", index, recipe.frames() - 1));
  }
  const FrameMaker maker(recipe, options.isa);
  const DatasetPaths paths{options.out};
  constexpr bool replace = false;  // a whole set is not given up for one frame
  const std::string plan = plan_json(maker, options.isa, SampleFormat::folder);
  check_folder_for(paths, plan, replace);
  const int place = maker.locate(index).place;
  maker.place(place);
  maker.check_trajectory(place);
  const FolderLock in_use = prepare_dataset(paths, plan, replace);
  std::vector<WrittenFile> files;
  return write_frame(maker, paths, maker.make(index), files).line;
}

}  // namespace ensonify
