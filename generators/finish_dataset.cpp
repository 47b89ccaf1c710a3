#include "ensonify/generators/finish_dataset.hpp"

#include <fmt/format.h>
#include <tbb/parallel_invoke.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <mutex>
#include <nlohmann/json.hpp>

#include "ensonify/core/error.hpp"
#include "ensonify/core/parallel.hpp"
#include "ensonify/generators/dataset_card.hpp"
#include "ensonify/generators/describe.hpp"
#include "ensonify/generators/json_text.hpp"
#include "ensonify/generators/write_block.hpp"
#include "ensonify/output/atomic_file.hpp"
#include "ensonify/output/grid_files.hpp"
#include "ensonify/output/sha256.hpp"
#include "ensonify/output/trajectory_file.hpp"

namespace ensonify {
namespace {

using nlohmann::json;

/// Frames of the dataset at each place, ascending.
std::vector<std::vector<int>> frames_by_place(const FrameMaker& maker) {
  std::vector<std::vector<int>> frames(maker.places().size());
  for (int i = 0; i < maker.recipe().frames(); ++i) {
    frames[static_cast<std::size_t>(maker.locate(i).place)].push_back(i);
  }
  return frames;
}

[[noreturn]] void refuse_observed(const DatasetPaths& paths, const Block& block) {
  throw DataError(fmt::format("{}: observes cells that the places do not have; delete {} to make the block again",
                              paths.observed(block.index).string(), paths.block(block.index).string()));
}

/// Of every place, the cells that some frame observed: one bit a cell, in the order of GridFrame::index.
std::vector<std::vector<bool>> observed_of_places(const FrameMaker& maker, const DatasetPaths& paths,
                                                  const std::vector<Block>& blocks) {
  std::vector<std::vector<bool>> seen;
  for (int place = 0; place < static_cast<int>(maker.places().size()); ++place) {
    seen.emplace_back(maker.place(place).truth.frame.cells());
  }
  for (const Block& block : blocks) {
    for (const ObservedCells& frame : read_observed(paths, block)) {
      if (static_cast<std::size_t>(frame.place) >= seen.size()) refuse_observed(paths, block);
      std::vector<bool>& cells = seen[static_cast<std::size_t>(frame.place)];
      for (const CellRun& run : frame.runs) {
        if (std::size_t{run.first} + run.count > cells.size()) refuse_observed(paths, block);
        std::fill_n(cells.begin() + run.first, run.count, true);
      }
    }
  }
  return seen;
}

std::string write_grids(const DatasetPaths& paths, const std::string& place, const OccupancyGrid& grid) {
  for (const char* extension : {".npz", ".bt", ".pgm"}) write_grid(grid, paths.grid(place, extension));
  return Sha256().add(grid.occupancy).add(grid.observable).hex();
}

void write_trajectories(const FrameMaker& maker, const DatasetPaths& paths, const std::vector<std::vector<int>>& frames,
                        std::vector<std::filesystem::path>& files) {
  for (std::size_t place = 0; place < frames.size(); ++place) {
    if (!maker.trajectory(static_cast<int>(place))) continue;
    std::vector<StampedPose> truth;
    std::vector<StampedPose> estimate;
    std::string split;
    for (const int index : frames[place]) {
      const FramePose pose = maker.pose(index);
      split = maker.recipe().splits[static_cast<std::size_t>(pose.split)].name;
      truth.push_back({*pose.time_s, pose.T_world_sonar});
      estimate.push_back({*pose.time_s, pose.T_world_sonar_est});
    }
    const auto folder = paths.root / split / "trajectories";
    files.push_back(folder / (maker.places()[place].name + ".txt"));
    write_tum(files.back(), truth);
    files.push_back(folder / (maker.places()[place].name + "_est.txt"));
    write_tum(files.back(), estimate);
  }
}

void close_written(std::ofstream& out, const std::filesystem::path& file) {
  errno = 0;
  out.close();
  if (!out) throw disk_error(file, errno != 0 ? std::strerror(errno) : "the disk does not take it");
}

/// Writes metadata.jsonl of every split from the block records; returns a manifest entry a block, and adds every
/// frame's hash to `root`.
json write_metadata(const FrameMaker& maker, const DatasetPaths& paths, const std::vector<Block>& blocks, Sha256& root,
                    std::vector<std::filesystem::path>& files) {
  json shards = json::array();
  for (std::size_t s = 0; s < maker.recipe().splits.size(); ++s) {
    const std::string& split = maker.recipe().splits[s].name;
    const auto file = paths.root / split / "metadata.jsonl";
    write_atomically(file, [&](const std::filesystem::path& temporary) {
      std::ofstream out(temporary, std::ios::binary);
      for (const Block& block : blocks) {
        if (block.split != static_cast<int>(s)) continue;
        Sha256 hash;
        for (const FrameRecord& record : read_block_record(paths, block).frames) {
          out << record.line << '\n';
          hash.add(std::string_view(record.sha256));
          root.add(std::string_view(record.sha256));
        }
        shards.push_back(
            {{"split", split}, {"first_index", block.first}, {"frames", block.frames}, {"sha256", hash.hex()}});
      }
      close_written(out, file);
    });
    files.push_back(file);
  }
  return shards;
}

/// Writes checksums.txt, as `sha256sum -c` reads it: the files of the blocks, then `others`. Returns its own hash.
std::string write_checksums(const DatasetPaths& paths, const std::vector<Block>& blocks,
                            const std::vector<std::filesystem::path>& others) {
  write_atomically(paths.checksums(), [&](const std::filesystem::path& temporary) {
    std::ofstream out(temporary, std::ios::binary);
    for (const Block& block : blocks) {
      for (const WrittenFile& f : read_block_record(paths, block).files) out << f.sha256 << "  " << f.name << '\n';
    }
    for (const auto& file : others) {
      out << sha256_of_file(file) << "  " << file.lexically_relative(paths.root).generic_string() << '\n';
    }
    close_written(out, paths.checksums());
  });
  return sha256_of_file(paths.checksums());
}

/// How each trajectory moves: one entry a place.
json describe_motion(const FrameMaker& maker) {
  json entries = json::array();
  for (int place = 0; place < static_cast<int>(maker.places().size()); ++place) {
    const Trajectory* trajectory = maker.trajectory(place);
    if (!trajectory) continue;
    const Motion motion = motion_of(*trajectory, maker.swum_until_s(place));
    json entry{{"place", maker.places()[static_cast<std::size_t>(place)].name},
               {"duration_s", maker.swum_until_s(place)},
               {"length_m", motion.length_m},
               {"max_speed_mps", motion.max_speed_mps},
               {"max_acceleration_mps2", motion.max_acceleration_mps2},
               {"max_turn_rate_degps", degrees(motion.max_turn_rate_radps)}};
    if (trajectory->speed_mps()) entry["speed_mps"] = *trajectory->speed_mps();
    entries.push_back(entry);
  }
  return entries;
}

json label_legend() {
  return {{"0", "water"},    {"1", "direct echo"}, {"2", "multipath"},
          {"3", "sidelobe"}, {"4", "shadow"},      {"5", "outside"}};
}

}  // namespace

bool finish_dataset(const FrameMaker& maker, const DatasetPaths& paths, const std::vector<Block>& blocks,
                    const GenerateOptions& options) {
  const Recipe& recipe = maker.recipe();
  const auto frames = frames_by_place(maker);
  const int places = static_cast<int>(maker.places().size());
  Progress progress{0, 0, places, "grids"};
  std::mutex mutex;
  const auto after_place = [&] {
    const std::scoped_lock lock(mutex);
    ++progress.done;
    ++progress.fresh;
    options.on_progress(progress);
  };

  Sha256 root;
  std::vector<std::filesystem::path> files;  // beside those of the blocks
  json shards;
  std::vector<std::vector<bool>> seen;
  tbb::parallel_invoke([&] { shards = write_metadata(maker, paths, blocks, root, files); },
                       [&] { seen = observed_of_places(maker, paths, blocks); });
  std::vector<std::string> hashes(maker.places().size());
  parallel_for(places, [&](int place) {
    if (options.stopped()) return;
    const auto p = static_cast<std::size_t>(place);
    OccupancyGrid grid = maker.place(place).truth;
    grid.observable.assign(seen[p].begin(), seen[p].end());
    hashes[p] = write_grids(paths, maker.places()[p].name, grid);
    after_place();
  });
  if (options.stopped()) return false;
  json grids = json::array();
  for (std::size_t p = 0; p < hashes.size(); ++p) {
    const std::string& name = maker.places()[p].name;
    for (const char* extension : {".npz", ".bt", ".pgm", ".yaml"}) files.push_back(paths.grid(name, extension));
    root.add(std::string_view(hashes[p]));
    grids.push_back({{"place", name}, {"file", "grids/" + name + ".npz"}, {"sha256", hashes[p]}});
  }
  write_trajectories(maker, paths, frames, files);

  json manifest{{"schema", dataset_schema},
                {"schema_version", 1},
                {"tool", {{"name", "ensonify"}, {"version", ENSONIFY_VERSION}}},
                {"command_line", options.command_line},
                {"recipe", describe(recipe)},
                {"sonar", describe(maker.sonar())},
                {"noise", describe(maker.noises())},
                {"seed", recipe.seed},
                {"isa", options.isa},
                {"format", options.format == SampleFormat::folder ? "folder" : "webdataset"},
                {"mask", {{"threshold", recipe.mask_threshold}, {"values", {0, 255}}}},
                {"labels", label_legend()},
                {"shards", shards},
                {"grids", grids},
                {"trajectories", describe_motion(maker)},
                {"root_hash", root.hex()}};
  for (const Split& split : recipe.splits) manifest["counts"][split.name] = split.frames;
  remove_abandoned(paths.root);
  write_dataset_card(paths, manifest, recipe);
  write_croissant(paths, manifest);
  files.insert(files.end(), {paths.root / "README.md", paths.root / "croissant.json"});
  manifest["checksums"] = {{"file", paths.checksums().filename().string()},
                           {"sha256", write_checksums(paths, blocks, files)}};
  write_file(paths.manifest(), sealed_manifest(manifest));
  return true;
}

}  // namespace ensonify
