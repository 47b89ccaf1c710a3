#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <new>
#include <string>
#include <system_error>
#include <vector>

#include "ensonify/cli/commands.hpp"
#include "ensonify/cli/signals.hpp"
#include "ensonify/cli/streams.hpp"
#include "ensonify/config/reader.hpp"
#include "ensonify/core/error.hpp"
#include "ensonify/core/memory.hpp"

namespace {

using namespace ensonify;

/// CLI11 only says that a subcommand is missing where one is misspelt: names the word and the nearest command.
void check_command(const CLI::App& app, const std::vector<std::string>& words) {
  if (words.empty() || words[0].starts_with('-')) return;
  std::vector<std::string> names;
  for (const CLI::App* command : app.get_subcommands([](const CLI::App*) { return true; })) {
    names.push_back(command->get_name());
  }
  if (names.empty()) return;
  if (const auto found = std::find(names.begin(), names.end(), words[0]); found != names.end()) {
    return check_command(*app.get_subcommand(words[0]), {words.begin() + 1, words.end()});
  }
  const std::string nearest = nearest_word(words[0], names);
  throw ConfigError(fmt::format("no command '{}'; {}", words[0],
                                nearest.empty() ? fmt::format("there are {}", fmt::join(names, ", "))
                                                : fmt::format("did you mean '{}'?", nearest)));
}

int run(int argc, char** argv) {
  CLI::App app(
      "ensonify simulates multibeam imaging sonars on the CPU: scenes in, sonar images with masks, labels and\n"
      "occupancy truth out.");
  app.name("ensonify");
  app.set_version_flag("--version", std::string("ensonify ") + ENSONIFY_VERSION);
  app.require_subcommand(1);
  app.footer(
      "Example:\n  ensonify ping test_tank --sonar oculus_m1200d_hf --pose \"1.0 0 -1.5 0 10 0\" --out out/ping\n\n"
      "Exit codes: 0 done, 1 the work failed (data, disk), 2 wrong usage or configuration, 130/143 stopped.");
  cli::add_evaluate(app);
  cli::add_explore(app);
  cli::add_filter(app);
  cli::add_generate(app);
  cli::add_map(app);
  cli::add_ping(app);
  cli::add_reproduce(app);
  cli::add_scene(app);
  cli::add_sonar(app);
  cli::add_stats(app);
  cli::add_verify(app);
  cli::add_voxelize(app);
  try {
    check_command(app, {argv + std::min(argc, 1), argv + argc});
    app.parse(argc, argv);
    return 0;
  } catch (const CLI::ParseError& e) {
    // CLI11 answers --help and --version with 0; every misuse is code 2.
    return app.exit(e) == 0 ? 0 : 2;
  } catch (const cli::ExitCode& e) {
    return e.code;
  } catch (const ConfigError& e) {
    cli::complain(e.what());
    return 2;
  } catch (const std::bad_alloc&) {
    cli::complain("out of memory");
    return 1;
  } catch (const std::filesystem::filesystem_error& e) {
    cli::complain(e.what());
    return 1;
  } catch (const std::system_error& e) {
    // fmt::print's, since files are written by DiskError's rules; what is wrong shows when the stream is finished.
    if (std::ferror(stdout) != 0 && e.code().value() == EPIPE) return 0;
    cli::complain(fmt::format("standard output: {}", e.what()));
    return 1;
  } catch (const std::exception& e) {
    cli::complain(e.what());
    return 1;
  }
}

}  // namespace

int main(int argc, char** argv) {
  keep_freed_pages();
  cli::hold_standard_streams();
  cli::end_at_signals();
  return cli::finish_standard_output(run(argc, argv));
}
