#include <fmt/format.h>
#include <fmt/ostream.h>
#include <fmt/ranges.h>
#include <tbb/global_control.h>

#include <fstream>
#include <iostream>
#include <memory>

#include "ensonify/cli/arguments.hpp"
#include "ensonify/cli/commands.hpp"
#include "ensonify/cli/progress.hpp"
#include "ensonify/cli/signals.hpp"
#include "ensonify/config/library.hpp"
#include "ensonify/core/error.hpp"
#include "ensonify/generators/generate.hpp"

namespace ensonify::cli {
namespace {

struct Arguments {
  std::string recipe;
  std::string out;
  int pairs = 0;
  std::int64_t seed = -1;
  int jobs = 0;
  std::string shard = "0/1";
  int only = -1;
  std::string format = "folder";
  std::string isa = default_isa;
  std::string progress = "auto";
  bool force = false;
};

Recipe recipe_of(const Arguments& arguments) {
  Recipe recipe = load_recipe(arguments.recipe);
  if (arguments.seed >= 0) recipe.seed = static_cast<std::uint64_t>(arguments.seed);
  if (arguments.pairs > 0) set_training_pairs(recipe, arguments.pairs);
  return recipe;
}

void set_shard(const std::string& text, GenerateOptions& options) {
  int used = 0;
  if (std::sscanf(text.c_str(), "%d/%d%n", &options.shard, &options.shards, &used) != 2 ||
      used != static_cast<int>(text.size()) || options.shards < 1 || options.shard < 0 ||
      options.shard >= options.shards) {
    throw ConfigError(fmt::format("--shard {}: must be K/N with K from 0 to N - 1, such as 0/4", text));
  }
}

void run(const Arguments& arguments) {
  GenerateOptions options;
  set_shard(arguments.shard, options);
  const Recipe recipe = recipe_of(arguments);
  std::unique_ptr<tbb::global_control> jobs;
  if (arguments.jobs > 0) {
    jobs = std::make_unique<tbb::global_control>(tbb::global_control::max_allowed_parallelism, arguments.jobs);
  }
  options.out = arguments.out;
  options.format = arguments.format == "folder" ? SampleFormat::folder : SampleFormat::webdataset;
  options.force = arguments.force;
  options.isa = arguments.isa;
  options.command_line = command_line_of(arguments.recipe, recipe, options.isa, options.format, arguments.pairs);
  if (arguments.only >= 0) {
    fmt::print("{}\n", generate_only(recipe, options, arguments.only));
    return;
  }
  watch_signals();
  ProgressLine progress(parse_progress_style(arguments.progress));
  options.on_progress = [&](const Progress& p) { progress.show(p.stage, p.done, p.fresh, p.total); };
  options.on_lost = [&](const std::string& file) {
    fmt::print(
        std::cerr,
        "ensonify: {0}/{1}: gone or cut short since the set was finished; files that are not there in full are made "
        "again. What else changed is found by: ensonify verify {0}\n",
        arguments.out, file);
  };
  options.stopped = [] { return caught_signal() != 0; };
  switch (generate(recipe, options)) {
    case Outcome::complete:
      fmt::print("{} frames in {}; check them with: ensonify verify {}\n", recipe.frames(), arguments.out,
                 arguments.out);
      break;
    case Outcome::shard_done:
      fmt::print("shard {} done; the dataset is finished by whichever shard comes last\n", arguments.shard);
      break;
    case Outcome::stopped:
      fmt::print(std::cerr, "\nensonify: stopped; the same command resumes\n");
      throw ExitCode{128 + caught_signal()};
  }
}

}  // namespace

void add_generate(CLI::App& app) {
  auto* command = app.add_subcommand("generate", "Make a dataset from a recipe; the same command again resumes");
  auto a = std::make_shared<Arguments>();
  command
      ->add_option("RECIPE", a->recipe,
                   fmt::format("Recipe YAML, a set's dataset.json, or a bundled name: {}",
                               fmt::join(library_names("generators"), ", ")))
      ->required();
  command->add_option("--out", a->out, "Folder of the dataset")->required()->check(some_path());
  command->add_option("--pairs", a->pairs, "Training pairs instead of the recipe's")->check(CLI::Range(1, 100'000'000));
  command->add_option("--seed", a->seed, "Seed instead of the recipe's")
      ->check(CLI::Range(std::int64_t{0}, std::int64_t{9'000'000'000'000'000}));
  command->add_option("--jobs", a->jobs, "Threads; the images do not depend on it (default: all cores)")
      ->check(CLI::Range(1, 1024));
  command->add_option("--shard", a->shard, "K/N: make the K-th of N parts, K from 0; all parts write into one --out");
  command->add_option("--only", a->only, "Make this one frame again (index over the whole set) and print its metadata")
      ->check(CLI::NonNegativeNumber);
  command->add_option("--format", a->format, "folder, or webdataset: tar shards")
      ->check(CLI::IsMember({"folder", "webdataset"}));
  command->add_option("--isa", a->isa, "Instruction set of the ray caster; part of the result")
      ->check(CLI::IsMember({"avx2", "avx512", "sse4.2", "sse2", "auto"}));
  command->add_option("--progress", a->progress, "auto, json or none")->check(CLI::IsMember({"auto", "json", "none"}));
  command->add_flag("--force", a->force, "Replace a dataset of another recipe in --out");
  command->footer(
      "Example:\n  ensonify generate quick --out out/quick\n  ensonify generate paper --seed 7 --out out/paper7");
  command->callback([a] { run(*a); });
}

}  // namespace ensonify::cli
