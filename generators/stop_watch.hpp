#pragma once

#include <chrono>
#include <utility>

namespace ensonify {

/// The computer's clock, for times that are reported apart and never part of a result.
class StopWatch {
 public:
  /// Seconds since the last call.
  double lap_s() {
    const auto now = std::chrono::steady_clock::now();
    return std::chrono::duration<double>(now - std::exchange(last_, now)).count();
  }

 private:
  std::chrono::steady_clock::time_point last_ = std::chrono::steady_clock::now();
};

}  // namespace ensonify
