#include "ensonify/reproduction/conclusions.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "ensonify/evaluation/filter_figures.hpp"
#include "ensonify/reproduction/map_conclusions.hpp"
#include "ensonify/reproduction/map_curves.hpp"

namespace ensonify {
namespace {

using Verdict = Conclusion::Verdict;
using Kind = Contender::Kind;

std::vector<const Contender*> of_kind(const Findings& found, Kind kind) {
  std::vector<const Contender*> chosen;
  for (const Contender& c : found.contenders) {
    if (c.kind == kind) chosen.push_back(&c);
  }
  return chosen;
}

double psnr_of(const FilterReport& report, const Contender& contender, const std::string& scene) {
  const FilterScores* row = row_of(report, contender, scene);
  return row ? (row->*contender.psnr_db).value : std::nan("");
}

/// The greatest PSNR of any classical filter in a scene: as it is, under its own mask, or as a mask of the raw image.
std::pair<double, std::string> strongest(const FilterReport& report, const std::string& scene) {
  std::pair<double, std::string> best{-HUGE_VAL, ""};
  for (const FilterScores& row : report.rows) {
    if (row.scene != scene || row.filter == "raw" || row.filter == "truth_mask" || row.filter.starts_with("unet"))
      continue;
    for (const double value : {row.psnr_db.value, row.gated_psnr_db.value, row.masked_psnr_db.value}) {
      if (value > best.first) best = {value, row.preset + " " + row.filter};
    }
  }
  return best;
}

Conclusion best_psnr(const Findings& found) {
  Conclusion c{"The learned filter has the highest PSNR in every scene", "", Verdict::not_measured};
  const Contender *learned = named(found, "learned"), *clean = named(found, "learned_clean");
  if (!found.filters || !learned) return c;
  std::size_t held = 0, held_against_all = 0, scenes = 0;
  std::vector<std::string> lines;
  for (const std::string& scene : scenes_of(*found.filters)) {
    std::pair<double, std::string> best{-HUGE_VAL, ""};
    for (const Contender* other : of_kind(found, Kind::classical)) {
      best = std::max(best, {psnr_of(*found.filters, *other, scene), other->label});
    }
    const double ours = psnr_of(*found.filters, *learned, scene), cleaned = psnr_of(*found.filters, *clean, scene);
    const auto [any, name] = strongest(*found.filters, scene);
    held += ours > best.first;
    held_against_all += cleaned > any;
    ++scenes;
    lines.push_back(
        fmt::format("{}: {:.1f} dB, best of the paper's others {:.1f} ({}); its clean head {:.1f}, best "
                    "classical of any kind {:.1f} ({})",
                    scene, ours, best.first, best.second, cleaned, any, name));
  }
  c.verdict = verdict_of(held, scenes);
  c.measured = fmt::format(
      "Its mask on the raw image is best of the paper's filters in {} of {} scenes, the clean head "
      "best of all filters in {}. {}.",
      held, scenes, held_against_all, fmt::join(lines, "; "));
  return c;
}

Conclusion best_classical(const Findings& found) {
  Conclusion c{"The wavelet filter is the best of the classical ones", "", Verdict::not_measured};
  if (!found.filters) return c;
  std::vector<std::pair<double, std::string>> psnr;
  for (const Contender* other : of_kind(found, Kind::classical)) {
    psnr.emplace_back(psnr_of(*found.filters, *other, "all"), other->label);
  }
  std::ranges::sort(psnr, std::greater<>());
  std::vector<std::string> order;
  for (const auto& [value, label] : psnr) order.push_back(fmt::format("{} {:.2f} dB", label, value));
  bool in_maps = true;
  if (found.maps) {
    std::vector<std::pair<double, std::string>> balanced;
    for (const Contender* other : of_kind(found, Kind::classical)) {
      if (const MapCurve* curve = curve_of(found.maps->report, "all", other->label, "points", "true")) {
        balanced.emplace_back(best_balanced_accuracy(*curve), other->label);
      }
    }
    std::ranges::sort(balanced, std::greater<>());
    in_maps = !balanced.empty() && balanced[0].second == "wavelet";
    for (auto& [value, label] : balanced) label = fmt::format("{} {:.3f}", label, value);
    std::vector<std::string> labels;
    for (const auto& [value, label] : balanced) labels.push_back(label);
    c.measured = fmt::format(" Maps, balanced accuracy at each one's best t: {}.", fmt::join(labels, ", "));
  }
  c.measured = fmt::format("PSNR over all scenes, the paper's parameters: {}.{}", fmt::join(order, ", "), c.measured);
  const bool in_psnr = psnr[0].second == "wavelet";
  c.verdict = in_psnr && in_maps ? Verdict::holds : in_psnr || in_maps ? Verdict::changes : Verdict::does_not_hold;
  return c;
}

const FilterScores* tank_row(const Findings& found, const std::string& model) {
  if (!found.tank_masks) return nullptr;
  const auto row = std::ranges::find_if(found.tank_masks->rows,
                                        [&](const FilterScores& r) { return r.preset == model && r.scene == "all"; });
  return row == found.tank_masks->rows.end() ? nullptr : &*row;
}

std::string with_interval(const Estimate& e) {
  return fmt::format("{:.3f} ({:.3f} to {:.3f})", e.value, e.low, e.high);
}

Conclusion more_pairs(const Findings& found) {
  Conclusion c{"Masks grow better from 25 to 50 to 100 training pairs", "", Verdict::not_measured};
  std::vector<std::string> order;
  std::vector<double> values;
  for (const char* model : {"tank_25", "tank_50", "tank_100", "tank_300", "tank_1000", "tank_3000"}) {
    const FilterScores* row = tank_row(found, model);
    if (!row) continue;
    if (values.size() < 3) values.push_back(row->iou.value);
    order.push_back(fmt::format("{} {}", model + 5, with_interval(row->iou)));
  }
  if (values.size() < 3) return c;
  c.verdict = verdict_of((values[1] > values[0]) + (values[2] > values[1]), 2);
  c.measured = fmt::format("IoU of the mask in the tank by pairs: {}.", fmt::join(order, ", "));
  return c;
}

Conclusion fine_tuning(const Findings& found) {
  Conclusion c{"Fine-tuning the model of simulated noise on 100 pairs of the other kind fails", "",
               Verdict::not_measured};
  const FilterScores *tuned = tank_row(found, "transfer"), *scratch = tank_row(found, "tank_100"),
                     *before = tank_row(found, "paper_small");
  if (!tuned || !scratch || !before) return c;
  const bool helps = tuned->iou.value > before->iou.value, pays = tuned->iou.value > scratch->iou.value;
  c.verdict = pays && helps ? Verdict::does_not_hold : helps ? Verdict::changes : Verdict::holds;
  c.measured = fmt::format("IoU before {}, after {}; from the 100 pairs alone, in four times as many steps, {}.",
                           with_interval(before->iou), with_interval(tuned->iou), with_interval(scratch->iou));
  return c;
}

Conclusion multipath(const Findings& found) {
  Conclusion c{"The learned filter can not remove multipath", "", Verdict::not_measured};
  if (!found.ghosts) return c;
  std::size_t held = 0, scenes = 0;
  std::vector<std::string> lines;
  for (const std::string& scene : scenes_of(*found.ghosts)) {
    double ours = std::nan(""), best = 0;
    for (const FilterScores& row : found.ghosts->rows) {
      if (row.scene != scene || row.filter == "truth_mask") continue;
      if (row.filter == "unet") ours = row.ghosts_removed.value;
      if (!row.filter.starts_with("unet")) best = std::max(best, row.ghosts_removed.value);
    }
    if (!std::isfinite(ours)) continue;
    ++scenes;
    held += !(ours >= 2 * best && ours > 0.05);
    lines.push_back(fmt::format("{} {:.1f} % (best classical {:.1f} %)", scene, 100 * ours, 100 * best));
  }
  c.verdict = verdict_of(held, scenes);
  c.measured = fmt::format(
      "Its energy removed while 90 % of the direct pixels stay, trained with multipath as "
      "background: {}.",
      fmt::join(lines, ", "));
  return c;
}

Conclusion order_of_times(const Findings& found) {
  Conclusion c{"By time a frame: anisodiff, wavelet, learned, then Lee enhanced and Frost far behind", "",
               Verdict::not_measured, true};
  std::vector<std::pair<double, std::string>> order;
  for (const FilterTime& time : found.times.filters) {
    if (time.label != "learned_clean") order.emplace_back(time.s, time.label);
  }
  if (order.empty()) return c;
  std::ranges::sort(order);
  std::vector<std::string> words;
  for (const auto& [s, label] : order) words.push_back(fmt::format("{} {:.1f} ms", label, 1e3 * s));
  const std::vector<std::string> theirs{"anisodiff", "wavelet", "learned", "lee_enhanced", "frost"};
  const bool same = std::ranges::equal(order, theirs, {}, &std::pair<double, std::string>::second);
  c.verdict = same ? Verdict::holds : Verdict::does_not_hold;
  c.measured = fmt::format("{}. Theirs was the order of interpreted loops.", fmt::join(words, ", "));
  return c;
}

}  // namespace

Verdict verdict_of(std::size_t held, std::size_t of) {
  if (of == 0) return Verdict::not_measured;
  return held == of ? Verdict::holds : held == 0 ? Verdict::does_not_hold : Verdict::changes;
}

const Contender* named(const Findings& found, const std::string& label) {
  const auto at = std::ranges::find(found.contenders, label, &Contender::label);
  return at == found.contenders.end() ? nullptr : &*at;
}

std::string words(Conclusion::Verdict verdict) {
  switch (verdict) {
    case Verdict::holds:
      return "holds";
    case Verdict::changes:
      return "changes";
    case Verdict::does_not_hold:
      return "does not hold";
    default:
      return "not measured";
  }
}

std::vector<Conclusion> conclusions_of(const Findings& found) {
  return {best_psnr(found),  lowest_fpr(found),  lowest_fnr(found), best_map(found),      best_classical(found),
          more_pairs(found), fine_tuning(found), multipath(found),  order_of_times(found)};
}

std::string conclusions_json(const std::vector<Conclusion>& conclusions) {
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  for (const Conclusion& c : conclusions) {
    if (!c.by_the_clock) list.push_back({{"claim", c.claim}, {"verdict", words(c.verdict)}, {"measured", c.measured}});
  }
  return list.dump(1, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n";
}

}  // namespace ensonify
