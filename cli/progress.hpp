#pragma once

#include <chrono>
#include <string>

namespace ensonify::cli {

enum class ProgressStyle { automatic, json, none };

/// Shows how far a long work is, on standard error: a bar with rate and time left on a terminal, a line every few
/// seconds otherwise, or one JSON object a line. Not for several threads at once.
class ProgressLine {
 public:
  explicit ProgressLine(ProgressStyle style);

  /// `fresh`: done in this run, which the rate counts from when the stage before was last shown. Time left is unknown
  /// (null in JSON) while there is no rate.
  void show(const std::string& stage, int done, int fresh, int total);

 private:
  using Clock = std::chrono::steady_clock;
  ProgressStyle style_;
  bool terminal_;
  std::string stage_;
  Clock::time_point start_;  ///< of the stage
  Clock::time_point last_;   ///< call, shown or not
  Clock::time_point shown_;
};

ProgressStyle parse_progress_style(const std::string& word);

}  // namespace ensonify::cli
