#pragma once

#include <string>
#include <vector>

#include "ensonify/reproduction/findings.hpp"

namespace ensonify {

/// A conclusion of Lin et al. (ICRA 2023), and what became of it here.
struct Conclusion {
  enum class Verdict { holds, changes, does_not_hold, not_measured };
  std::string claim, measured;
  Verdict verdict = Verdict::not_measured;
  bool by_the_clock = false;  ///< no two runs measure the same
};
std::string words(Conclusion::Verdict verdict);

/// One each, from the numbers alone.
std::vector<Conclusion> conclusions_of(const Findings& findings);

/// Without what was measured by the clock.
std::string conclusions_json(const std::vector<Conclusion>& conclusions);

}  // namespace ensonify
