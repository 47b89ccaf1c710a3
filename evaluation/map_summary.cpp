#include "ensonify/evaluation/map_summary.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>

namespace ensonify {
namespace {

/// The curve of the same scene, filter and model with true poses.
const MapCurve* with_true_poses(const MapReport& report, const MapCurve& curve) {
  const auto found = std::ranges::find_if(report.curves, [&](const MapCurve& other) {
    return other.poses == "true" &&
           std::tie(curve.scene, curve.filter, curve.model) == std::tie(other.scene, other.filter, other.model);
  });
  return found == report.curves.end() ? nullptr : &*found;
}

std::string short_number(double value, int digits) {
  return std::isfinite(value) ? fmt::format("{:.{}f}", value, digits) : "-";
}

}  // namespace

std::vector<std::pair<std::string, double>> summary_of(const MapReport& report, const MapCurve& curve) {
  constexpr double no_number = std::numeric_limits<double>::quiet_NaN();
  const std::size_t last = report.tolerances.size() - 1;
  const std::size_t best = curve.best(last);
  const MapCounts& n = curve.at[best];
  std::vector<std::pair<std::string, double>> values{
      {"best_threshold", report.thresholds[best]},  {"coverage", n.coverage()}, {"fpr", n.fpr()}, {"fnr", n.fnr()},
      {"balanced_accuracy", n.balanced_accuracy()}, {"brier", n.brier()},       {"iou", n.iou()}};
  for (std::size_t i = 0; i <= last; ++i) {
    values.emplace_back(fmt::format("precision_k{}", report.tolerances[i]), n.precision(i));
    values.emplace_back(fmt::format("recall_k{}", report.tolerances[i]), n.recall(i));
    values.emplace_back(fmt::format("f1_k{}", report.tolerances[i]), n.f1(i));
  }
  for (const double fpr : report.fprs)
    values.emplace_back(fmt::format("fnr_at_fpr_{}", fpr), fnr_at_fpr(curve.at, fpr));

  const MapCurve* truth = curve.poses == "true" ? nullptr : with_true_poses(report, curve);
  const std::size_t at = truth ? truth->best(last) : 0;
  const auto loss = [&](auto&& value) { return truth ? value(truth->at[at]) - value(curve.at[at]) : no_number; };
  values.emplace_back("loss_coverage", loss([](const MapCounts& c) { return c.coverage(); }));
  values.emplace_back("loss_balanced_accuracy", loss([](const MapCounts& c) { return c.balanced_accuracy(); }));
  for (std::size_t i = 0; i <= last; ++i) {
    values.emplace_back(fmt::format("loss_f1_k{}", report.tolerances[i]),
                        loss([i](const MapCounts& c) { return c.f1(i); }));
  }
  return values;
}

std::string map_table(const MapReport& report) {
  const std::size_t last = report.tolerances.size() - 1;
  const int k = report.tolerances[last];
  std::string text = fmt::format("{:<14} {:<11} {:<8} {:>3} {:>8} {:>6} {:>6} {:>6} {:>6} {:>8} {:>8} {:>8}\n",
                                 "filter", "model", "poses", "t", "coverage", "FPR", "FNR", "bal.", "Brier",
                                 fmt::format("prec_k{}", k), fmt::format("rec_k{}", k), fmt::format("F1_k{}", k));
  for (const MapCurve& curve : report.curves) {
    if (curve.scene != "all") continue;
    const std::size_t best = curve.best(last);
    const MapCounts& n = curve.at[best];
    text += fmt::format("{:<14} {:<11} {:<8} {:>3} {:>8} {:>6} {:>6} {:>6} {:>6} {:>8} {:>8} {:>8}\n", curve.filter,
                        curve.model, curve.poses, report.thresholds[best], short_number(n.coverage(), 3),
                        short_number(n.fpr(), 3), short_number(n.fnr(), 3), short_number(n.balanced_accuracy(), 3),
                        short_number(n.brier(), 3), short_number(n.precision(last), 3), short_number(n.recall(last), 3),
                        short_number(n.f1(last), 3));
  }
  return text;
}

}  // namespace ensonify
