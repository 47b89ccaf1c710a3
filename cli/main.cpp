#include <fmt/core.h>
#include <fmt/ostream.h>

#include <exception>
#include <iostream>
#include <new>

#include "ensonify/cli/commands.hpp"
#include "ensonify/core/error.hpp"

int main(int argc, char** argv) {
  using namespace ensonify;
  CLI::App app(
      "ensonify simulates multibeam imaging sonars on the CPU: scenes in, sonar images with masks, labels and\n"
      "occupancy truth out.");
  app.name("ensonify");
  app.set_version_flag("--version", std::string("ensonify ") + ENSONIFY_VERSION);
  app.require_subcommand(1);
  app.footer(
      "Example:\n  ensonify ping test_tank --sonar oculus_m1200d_hf --pose \"1.0 0 -1.5 0 10 0\" --out out/ping\n\n"
      "Exit codes: 0 done, 1 the work failed (data, disk), 2 wrong usage or configuration, 130/143 stopped.");
  cli::add_generate(app);
  cli::add_ping(app);
  cli::add_scene(app);
  cli::add_sonar(app);
  cli::add_verify(app);
  cli::add_voxelize(app);
  try {
    app.parse(argc, argv);
    return 0;
  } catch (const CLI::ParseError& e) {
    // CLI11 answers --help and --version with 0; every misuse is code 2.
    return app.exit(e) == 0 ? 0 : 2;
  } catch (const cli::ExitCode& e) {
    return e.code;
  } catch (const ConfigError& e) {
    fmt::print(std::cerr, "ensonify: {}\n", e.what());
    return 2;
  } catch (const std::bad_alloc&) {
    fmt::print(std::cerr, "ensonify: out of memory\n");
    return 1;
  } catch (const std::exception& e) {
    fmt::print(std::cerr, "ensonify: {}\n", e.what());
    return 1;
  }
}
