#pragma once

#include <functional>
#include <optional>
#include <string>

#include "ensonify/generators/dataset_plan.hpp"

namespace ensonify {

struct Progress {
  int done = 0;   ///< frames (of the stages places and grids: places) finished, those of earlier runs included
  int fresh = 0;  ///< of them made in this run
  int total = 0;
  const char* stage = "frames";
};

struct GenerateOptions {
  std::filesystem::path out;
  SampleFormat format = SampleFormat::folder;
  int shard = 0;  ///< this process makes the blocks b with b % shards == shard
  int shards = 1;
  bool force = false;
  std::string isa = default_isa;
  std::string command_line;
  std::function<void(const Progress&)> on_progress = [](const Progress&) {};
  /// The set was finished, but this file of it is gone or cut short: what is missing is made again.
  std::function<void(const std::string& file)> on_lost = [](const std::string&) {};
  std::function<bool()> stopped = [] { return false; };
};

enum class Outcome {
  complete,    ///< dataset.json is written
  shard_done,  ///< this shard's blocks are there, others' are missing
  stopped,     ///< options.stopped() said so; call again to resume
};

/// The command that makes it, for its manifest; `pairs` 0: the recipe's own.
std::string command_line_of(const std::string& recipe_source, const Recipe& recipe, const std::string& isa,
                            SampleFormat format, int pairs);

/// Makes a dataset, or what is missing of it, of a finished one too. Frames that can not be made are listed in
/// failed.jsonl in the state folder, the others are made, then DataError. Throws ConfigError and DataError.
Outcome generate(const Recipe& recipe, const GenerateOptions& options);

/// Writes the files of one frame only, into the same places; returns its metadata line.
std::string generate_only(const Recipe& recipe, const GenerateOptions& options, int index);

}  // namespace ensonify
