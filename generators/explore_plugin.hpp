#pragma once

#include <filesystem>
#include <functional>
#include <string>

#include "ensonify/generators/explore.hpp"
#include "ensonify/output/line_process.hpp"

namespace ensonify {

struct PluginSettings {
  std::string command;
  double timeout_s = 10;         ///< for every answer
  std::filesystem::path folder;  ///< for the images and maps that it is shown; removed at the end
  std::function<bool()> stop;    ///< see LineProcess
};

/// A user's mapper or planner as a program that reads and writes JSON lines (docs/explore.md). First it is told of
/// sonar, vehicle and map in one line; then for every ping it gets one line and answers with one.
class ExplorePlugin {
 public:
  ExplorePlugin(PluginSettings settings, const ExploreSite& site, const Vehicle& vehicle, const SonarModel& sonar,
                int steps);
  ~ExplorePlugin();
  ExplorePlugin(const ExplorePlugin&) = delete;
  ExplorePlugin& operator=(const ExplorePlugin&) = delete;

  /// Throws DataError: it has ended, does not answer in time, or with what makes no sense.
  GuestReply ask(const ExploreMoment& moment);

 private:
  PluginSettings settings_;
  Slice like_;
  GridFrame slab_;
  LineProcess process_;
};

/// What an answer says. Throws DataError naming `step`; `like` and `slab` as in read_guest_map().
GuestReply parse_reply(const std::string& line, int step, const Slice& like, const GridFrame& slab);

}  // namespace ensonify
