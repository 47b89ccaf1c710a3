#pragma once

#include <CLI/CLI.hpp>

namespace ensonify::cli {

/// Each adds one subcommand; its callback does the work and throws `Error`, or `ExitCode` to end with another code.
void add_evaluate(CLI::App& app);
void add_explore(CLI::App& app);
void add_filter(CLI::App& app);
void add_generate(CLI::App& app);
void add_map(CLI::App& app);
void add_ping(CLI::App& app);
void add_reproduce(CLI::App& app);
void add_scene(CLI::App& app);
void add_sonar(CLI::App& app);
void add_stats(CLI::App& app);
void add_verify(CLI::App& app);
void add_voxelize(CLI::App& app);

void add_evaluate_map(CLI::App& evaluate_command);
void add_scene_show(CLI::App& scene_command);
void add_scene_export(CLI::App& scene_command);
void add_sonar_show(CLI::App& sonar_command);

/// Ends the program with this code, silently.
struct ExitCode {
  int code = 0;
};

}  // namespace ensonify::cli
