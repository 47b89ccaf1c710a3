#include "ensonify/cli/progress.hpp"

#include <fmt/format.h>
#include <fmt/ostream.h>
#include <unistd.h>

#include <iostream>
#include <nlohmann/json.hpp>

namespace ensonify::cli {
namespace {

constexpr int bar_width = 30;

std::string time_text(double seconds) {
  const int s = static_cast<int>(seconds + 0.5);
  return s >= 3600 ? fmt::format("{}:{:02}:{:02}", s / 3600, s / 60 % 60, s % 60)
                   : fmt::format("{}:{:02}", s / 60, s % 60);
}

}  // namespace

ProgressLine::ProgressLine(ProgressStyle style)
    : style_(style), terminal_(::isatty(STDERR_FILENO) != 0), start_(Clock::now()), last_(start_) {}

ProgressStyle parse_progress_style(const std::string& word) {
  if (word == "json") return ProgressStyle::json;
  return word == "none" ? ProgressStyle::none : ProgressStyle::automatic;
}

void ProgressLine::show(const std::string& stage, int done, int fresh, int total) {
  if (style_ == ProgressStyle::none || total == 0) return;
  const auto now = Clock::now();
  if (stage != stage_) {
    stage_ = stage;
    start_ = last_;
    shown_ = Clock::time_point{};
  }
  last_ = now;
  const bool live = terminal_ && style_ == ProgressStyle::automatic;
  const auto pause = live ? std::chrono::milliseconds(100) : std::chrono::milliseconds(5000);
  if (done < total && now - shown_ < pause) return;
  shown_ = now;
  const double seconds = std::chrono::duration<double>(now - start_).count();
  const double rate = seconds > 0.0 ? fresh / seconds : 0.0;
  const bool known = rate > 0.0;  // a resumed stage may begin with nothing done in this run
  const double left_s = known ? (total - done) / rate : 0.0;
  const std::string pace =
      known ? fmt::format("  {:.{}f}/s  {} left", rate, rate < 10.0 ? 1 : 0, time_text(left_s)) : "";
  if (style_ == ProgressStyle::json) {
    nlohmann::json line{{"stage", stage}, {"done", done}, {"total", total}, {"rate_hz", rate}, {"eta_s", left_s}};
    if (!known && done < total) line["eta_s"] = nullptr;
    fmt::print(std::cerr, "{}\n", line.dump());
  } else if (live) {
    const int filled = static_cast<int>(static_cast<double>(bar_width) * done / total);
    fmt::print(std::cerr, "\r{} [{:=<{}}{:<{}}] {}/{}{} \033[K{}", stage, "", filled, "", bar_width - filled, done,
               total, pace, done == total ? "\n" : "");
  } else {
    fmt::print(std::cerr, "{} {}/{}{}\n", stage, done, total, pace);
  }
  std::cerr.flush();
}

}  // namespace ensonify::cli
