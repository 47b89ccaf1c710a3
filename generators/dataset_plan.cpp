#include "ensonify/generators/dataset_plan.hpp"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "ensonify/config/library.hpp"
#include "ensonify/core/error.hpp"
#include "ensonify/generators/describe.hpp"
#include "ensonify/generators/json_text.hpp"
#include "ensonify/output/atomic_file.hpp"
#include "ensonify/output/sha256.hpp"

namespace ensonify {
namespace {

namespace fs = std::filesystem;
/// In the order of removal: first what says that the set, or a part of it, is there.
constexpr std::array own_entries{
    "dataset.json", ".ensonify/blocks", "train",          "val",           "test",
    "grids",        "README.md",        "croissant.json", "checksums.txt", ".ensonify/failed.jsonl"};

bool holds_more_than_state(const DatasetPaths& paths) {
  std::error_code error;
  for (fs::directory_iterator entry(paths.root, error), end; !error && entry != end; entry.increment(error)) {
    if (entry->path().filename() != paths.state().filename()) return true;
  }
  return false;
}

bool holds(const fs::path& file) {
  std::error_code no_throw;
  return fs::is_regular_file(file, no_throw);
}

bool holds_plan(const DatasetPaths& paths, const std::string& plan) {
  return holds(paths.plan()) && read_text(paths.plan()) == plan;
}

[[noreturn]] void refuse_other_plan(const std::string& out) {
  throw ConfigError(
      fmt::format("--out {}: holds a dataset of another recipe, seed, ISA or format; name another folder, or replace "
                  "it with --force",
                  out));
}

}  // namespace

std::vector<Block> plan_blocks(const Recipe& recipe, SampleFormat format) {
  const int block_frames = format == SampleFormat::folder ? 16 : 256;
  std::vector<Block> blocks;
  int split_start = 0;
  for (std::size_t s = 0; s < recipe.splits.size(); ++s) {
    const int frames = recipe.splits[s].frames;
    for (int start = 0; start < frames; start += block_frames) {
      blocks.push_back({static_cast<int>(blocks.size()), static_cast<int>(s), split_start + start,
                        std::min(block_frames, frames - start), start / block_frames});
    }
    split_start += frames;
  }
  return blocks;
}

std::string plan_json(const FrameMaker& maker, const std::string& isa, SampleFormat format) {
  nlohmann::json plan;
  plan["tool_version"] = ENSONIFY_VERSION;
  plan["recipe"] = describe(maker.recipe());
  plan["sonar"] = describe(maker.sonar());
  plan["noise"] = describe(maker.noises());
  plan["isa"] = isa;
  plan["format"] = format == SampleFormat::folder ? "folder" : "webdataset";
  for (const PlaceRef& place : maker.places()) {
    if (plan["scene_sha256"].contains(place.scene)) continue;
    Sha256 hash;
    hash.add(read_file(resolve_name("scenes", place.scene)));
    for (const fs::path& mesh : scene_mesh_files(place.scene)) hash.add(read_file(mesh));
    plan["scene_sha256"][place.scene] = hash.hex();
  }
  for (const Split& split : maker.recipe().splits) {
    const auto* trajectory = std::get_if<TrajectoryPoses>(&split.poses);
    const auto* recorded = trajectory ? std::get_if<RecordedPath>(&trajectory->path) : nullptr;
    if (recorded) plan["trajectory_sha256"][split.name] = Sha256().add(read_file(recorded->file)).hex();
  }
  return json_text(plan);
}

fs::path DatasetPaths::block(int index) const { return state() / "blocks" / fmt::format("{:06}.json", index); }

fs::path DatasetPaths::observed(int block) const { return state() / "observed" / fmt::format("{:06}.bin", block); }

fs::path DatasetPaths::image(const std::string& split, const std::string& kind, int number) const {
  return root / split / kind / fmt::format("{:06}.{}", number, kind == "truth" ? "exr" : "png");
}

fs::path DatasetPaths::tar(const std::string& split, int number_in_split) const {
  return root / split / fmt::format("{}-{:06}.tar", split, number_in_split);
}

fs::path DatasetPaths::grid(const std::string& place, const std::string& extension) const {
  return root / "grids" / (place + extension);
}

bool is_complete(const DatasetPaths& paths, const std::string& plan) {
  return holds_plan(paths, plan) && holds(paths.manifest());
}

void check_folder_for(const DatasetPaths& paths, const std::string& plan, bool force) {
  std::error_code error;
  const std::string out = paths.root.string();
  if (paths.root.empty()) throw ConfigError("--out: must name a folder");
  if (fs::is_symlink(paths.root, error) && !fs::exists(paths.root, error)) {
    throw ConfigError(fmt::format("--out {}: is a link that leads nowhere", out));
  }
  if (fs::exists(paths.root, error) && !fs::is_directory(paths.root, error)) {
    throw ConfigError(fmt::format("--out {}: is a file, not a folder", out));
  }
  // In this order: another shard that starts now writes its plan before anything else.
  const bool in_use = holds_more_than_state(paths);
  if (!holds(paths.plan()) && in_use) {
    throw ConfigError(fmt::format("--out {}: holds other files; name a new or empty folder", out));
  }
  if (!force && holds(paths.plan()) && !holds_plan(paths, plan)) refuse_other_plan(out);
}

FolderLock prepare_dataset(const DatasetPaths& paths, const std::string& plan, bool force) {
  check_folder_for(paths, plan, force);
  const std::string out = paths.root.string();
  FolderLock lock(paths.state() / "lock");
  const auto is_ours = [&] { return write_new_file(paths.plan(), plan) || holds_plan(paths, plan); };
  if (is_ours()) return lock;
  if (!force) refuse_other_plan(out);
  if (!lock.hold_alone()) {
    throw ConfigError(
        fmt::format("--out {}: another process works in it; stop that one first, or name another folder", out));
  }
  std::error_code error;
  for (const char* entry : own_entries) fs::remove_all(paths.root / entry, error);
  write_file(paths.plan(), plan);
  lock.share();
  // Another one may have held the folder alone before the share was back.
  if (!is_ours()) throw ConfigError(fmt::format("--out {}: is being replaced by another process", out));
  return lock;
}

}  // namespace ensonify
