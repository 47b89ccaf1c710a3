#include "ensonify/reproduction/conclusions.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "ensonify/reproduction/map_curves.hpp"

/// Verdicts are computed from made-up findings whose truth is known.
namespace ensonify {
namespace {

using Verdict = Conclusion::Verdict;

const std::vector<Contender> made_up{
    {"raw", Contender::Kind::raw, "raw", ""},
    {"wavelet", Contender::Kind::classical, "wavelet", "paper"},
    {"frost", Contender::Kind::classical, "frost", "paper"},
    {"learned", Contender::Kind::learned, "unet", "paper", &FilterScores::masked_psnr_db},
    {"learned_clean", Contender::Kind::learned, "unet_clean", "paper"},
};

FilterScores row(const std::string& filter, const std::string& scene, double psnr_db, double masked_psnr_db) {
  FilterScores scores;
  scores.filter = filter;
  scores.preset = filter == "raw" ? "" : "paper";
  scores.scene = scene;
  scores.psnr_db.value = psnr_db;
  scores.masked_psnr_db.value = masked_psnr_db;
  return scores;
}

Findings with_psnr(double learned_in_dam) {
  Findings found;
  found.contenders = made_up;
  found.filters = FilterReport{"set", "", 1, 1, {}};
  for (const char* scene : {"all", "dam", "pier"}) {
    const double learned = std::string(scene) == "dam" ? learned_in_dam : 30;
    for (const FilterScores& r : {row("raw", scene, 20, 25), row("wavelet", scene, 24, 26), row("frost", scene, 23, 27),
                                  row("unet", scene, 13, learned), row("unet_clean", scene, 40, 30)}) {
      found.filters->rows.push_back(r);
    }
  }
  return found;
}

/// Cells of which a share is right, at thresholds 0, 1, 2.
MapCurve curve(const std::string& filter, std::vector<std::uint64_t> false_occupied) {
  MapCurve made{"all", filter, "points", "true", 1, {}};
  for (const std::uint64_t wrong : false_occupied) {
    MapCounts at;
    at.false_occupied = wrong;
    at.true_free = 100 - wrong;
    at.true_occupied = 10;
    made.at.push_back(at);
  }
  return made;
}

Findings with_maps(std::vector<std::uint64_t> learned_fnr) {
  Findings found;
  found.contenders = made_up;
  found.maps = MapFindings{{"set", "", "test", {0, 1, 2}, {0}, {}, {}}, {}};
  found.maps->report.curves = {curve("raw", {90, 80, 70}), curve("wavelet", {60, 50, 40}), curve("frost", {61, 51, 41}),
                               curve("learned", std::move(learned_fnr))};
  found.maps_as_the_paper = found.maps;
  return found;
}

Conclusion about(const Findings& found, const std::string& word) {
  const auto all = conclusions_of(found);
  const auto at = std::ranges::find_if(all, [&](const Conclusion& c) { return c.claim.find(word) != c.claim.npos; });
  EXPECT_NE(at, all.end()) << word;
  return at == all.end() ? Conclusion{} : *at;
}

TEST(Conclusions, NothingFoundNothingConcluded) {
  for (const Conclusion& c : conclusions_of({})) {
    EXPECT_EQ(c.verdict, Verdict::not_measured) << c.claim;
    EXPECT_EQ(c.measured, "") << c.claim;
  }
}

TEST(Conclusions, PsnrIsComparedSceneByScene) {
  EXPECT_EQ(about(with_psnr(30), "PSNR").verdict, Verdict::holds);
  EXPECT_EQ(about(with_psnr(23.5), "PSNR").verdict, Verdict::changes);
  Findings worse = with_psnr(23.5);
  for (FilterScores& r : worse.filters->rows) r.masked_psnr_db.value = std::min(r.masked_psnr_db.value, 23.5);
  EXPECT_EQ(about(worse, "PSNR").verdict, Verdict::does_not_hold);
  EXPECT_NE(about(with_psnr(23.5), "PSNR").measured.find("dam: 23.5 dB, best of the paper's others 24.0 (wavelet)"),
            std::string::npos)
      << about(with_psnr(23.5), "PSNR").measured;
}

TEST(Conclusions, RatesAreComparedThresholdByThreshold) {
  EXPECT_EQ(about(with_maps({60, 50, 40}), "lowest FNR").verdict, Verdict::holds);  // as low as the lowest
  EXPECT_EQ(about(with_maps({70, 60, 50}), "lowest FNR").verdict, Verdict::does_not_hold);
  const Conclusion c = about(with_maps({10, 10, 50}), "lowest FNR");
  EXPECT_EQ(c.verdict, Verdict::changes);
  EXPECT_NE(
      c.measured.find("lowest at 2 of 3 thresholds, not at t = 2 (mean over them 0.233, lowest of the others 0.500)"),
      std::string::npos)
      << c.measured;
}

TEST(Conclusions, TheWaveletIsBestByImagesAndMaps) {
  Findings found = with_psnr(30);
  EXPECT_EQ(about(found, "wavelet").verdict, Verdict::holds);
  found.maps = with_maps({0, 0, 0}).maps;
  EXPECT_EQ(about(found, "wavelet").verdict, Verdict::holds);
  std::swap(found.maps->report.curves[1].filter, found.maps->report.curves[2].filter);
  EXPECT_EQ(about(found, "wavelet").verdict, Verdict::changes);
}

TEST(Conclusions, PairsFineTuningAndTimes) {
  Findings found;
  found.contenders = made_up;
  found.tank_masks = FilterReport{"tank", "", 1, 1, {}};
  for (const auto& [model, iou] :
       {std::pair{"paper_small", 0.1}, {"tank_25", 0.5}, {"tank_50", 0.6}, {"tank_100", 0.55}, {"transfer", 0.7}}) {
    FilterScores scores;
    scores.filter = scores.preset = model;
    scores.scene = "all";
    scores.iou.value = iou;
    found.tank_masks->rows.push_back(scores);
  }
  EXPECT_EQ(about(found, "training pairs").verdict, Verdict::changes);
  // It fails where it is no better than before, and is as good as none where training from nothing gives more.
  EXPECT_EQ(about(found, "Fine-tuning").verdict, Verdict::does_not_hold);
  found.tank_masks->rows.back().iou.value = 0.5;
  EXPECT_EQ(about(found, "Fine-tuning").verdict, Verdict::changes);
  found.tank_masks->rows.back().iou.value = 0.05;
  EXPECT_EQ(about(found, "Fine-tuning").verdict, Verdict::holds);
  found.times.filters = {{"anisodiff", 1}, {"frost", 5},           {"wavelet", 2},
                         {"learned", 3},   {"learned_clean", 0.1}, {"lee_enhanced", 4}};
  EXPECT_EQ(about(found, "By time").verdict, Verdict::holds);
  EXPECT_EQ(conclusions_json(conclusions_of(found)).find("By time"), std::string::npos);
}

TEST(MapCurves, RangesOfNumbers) {
  EXPECT_EQ(ranges_of({}), "");
  EXPECT_EQ(ranges_of({4}), "4");
  EXPECT_EQ(ranges_of({0, 1, 2, 5, 7, 8}), "0 to 2, 5, 7 to 8");
}

}  // namespace
}  // namespace ensonify
