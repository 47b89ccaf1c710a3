#include "ensonify/reproduction/map_conclusions.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "ensonify/reproduction/map_curves.hpp"

namespace ensonify {
namespace {

using Verdict = Conclusion::Verdict;
using Kind = Contender::Kind;

struct LowestRates {
  std::size_t held = 0, all = 0;
  std::vector<int> lost;            ///< thresholds
  double ours = 0, best_other = 0;  ///< means over them
};

/// How often the learned filter's rate is the lowest of those of the paper's filters.
LowestRates lowest_rates(const Findings& found, const MapReport& report, double (MapCounts::*rate)() const) {
  LowestRates result;
  const MapCurve* learned = curve_of(report, "all", "learned", "points", "true");
  for (std::size_t t = 0; learned && t < learned->at.size(); ++t) {
    const double ours = (learned->at[t].*rate)();
    double best = HUGE_VAL;
    for (const Contender& other : found.contenders) {
      if (other.kind != Kind::raw && other.kind != Kind::classical) continue;
      const MapCurve* theirs = curve_of(report, "all", other.label, "points", "true");
      if (theirs && (theirs->at[t].*rate)() < best) best = (theirs->at[t].*rate)();
    }
    if (!std::isfinite(ours) || !std::isfinite(best)) continue;
    ++result.all;
    result.held += ours <= best;
    result.ours += ours;
    result.best_other += best;
    if (ours > best) result.lost.push_back(report.thresholds[t]);
  }
  result.ours /= static_cast<double>(result.all);
  result.best_other /= static_cast<double>(result.all);
  return result;
}

std::string told(const LowestRates& r) {
  return fmt::format("lowest at {} of {} thresholds{} (mean over them {:.3f}, lowest of the others {:.3f})", r.held,
                     r.all, r.lost.empty() ? "" : fmt::format(", not at t = {}", ranges_of(r.lost)), r.ours,
                     r.best_other);
}

Conclusion best_rate(const Findings& found, const char* name, double (MapCounts::*rate)() const) {
  Conclusion c{fmt::format("Maps behind the learned filter have the lowest {} at every threshold t", name), "",
               Verdict::not_measured};
  if (!found.maps || !found.maps_as_the_paper || !named(found, "learned")) return c;
  const LowestRates as_the_paper = lowest_rates(found, found.maps_as_the_paper->report, rate),
                    plain = lowest_rates(found, found.maps->report, rate);
  c.verdict = verdict_of(as_the_paper.held + plain.held, as_the_paper.all + plain.all);
  c.measured = fmt::format("All places, images sharpened and equalised as in the paper: {}. Images as they are: {}.",
                           told(as_the_paper), told(plain));
  return c;
}

}  // namespace

Conclusion lowest_fpr(const Findings& found) { return best_rate(found, "FPR", &MapCounts::fpr); }
Conclusion lowest_fnr(const Findings& found) { return best_rate(found, "FNR", &MapCounts::fnr); }

Conclusion best_map(const Findings& found) {
  Conclusion c{"So its map is the best one, whatever the threshold", "", Verdict::not_measured};
  if (!found.maps || !found.maps_as_the_paper || !named(found, "learned")) return c;
  std::size_t held = 0, all = 0;
  std::vector<std::string> told;
  for (const auto& [words, maps] : {std::pair{"equalised", &*found.maps_as_the_paper}, {"as they are", &*found.maps}}) {
    const MapReport& report = maps->report;
    std::pair<double, std::string> best{-1, ""};
    std::vector<int> lost;
    const MapCurve* ours = curve_of(report, "all", "learned", "points", "true");
    for (std::size_t t = 0; ours && t < ours->at.size(); ++t) {
      bool most = true;
      for (const Contender& other : found.contenders) {
        if (other.kind != Kind::raw && other.kind != Kind::classical) continue;
        const MapCurve* theirs = curve_of(report, "all", other.label, "points", "true");
        if (theirs && theirs->at[t].balanced_accuracy() > ours->at[t].balanced_accuracy()) most = false;
        if (theirs) best = std::max(best, {best_balanced_accuracy(*theirs), other.label});
      }
      ++all;
      held += most;
      if (!most) lost.push_back(report.thresholds[t]);
    }
    if (!ours) continue;
    told.push_back(fmt::format("images {}: {:.3f} at its own best t, best of the others {:.3f} ({}) at theirs; {}",
                               words, best_balanced_accuracy(*ours), best.first, best.second,
                               lost.empty() ? "best at every t" : "not best at t = " + ranges_of(lost)));
  }
  c.verdict = verdict_of(held, all);
  c.measured = fmt::format("Balanced accuracy, all places; {}.", fmt::join(told, "; "));
  return c;
}

}  // namespace ensonify
