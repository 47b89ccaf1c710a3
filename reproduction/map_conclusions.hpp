#pragma once

#include <cstddef>
#include <string>

#include "ensonify/reproduction/conclusions.hpp"

namespace ensonify {

/// Of the paper's filters, at every threshold, with images equalised as in the paper and as they are.
Conclusion lowest_fpr(const Findings& findings);
Conclusion lowest_fnr(const Findings& findings);
Conclusion best_map(const Findings& findings);

/// "holds" of all, "does not hold" of none, "changes" in between; not measured of 0.
Conclusion::Verdict verdict_of(std::size_t held, std::size_t of);

/// Null where there is no such contender.
const Contender* named(const Findings& findings, const std::string& label);

}  // namespace ensonify
