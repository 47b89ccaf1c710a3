#include "ensonify/evaluation/filter_page.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

namespace ensonify {
namespace {

constexpr double none = std::numeric_limits<double>::quiet_NaN();

FilterScores row(const std::string& filter, const std::string& preset, double ghosts) {
  FilterScores scores;
  scores.filter = filter;
  scores.preset = preset;
  scores.scene = "all";
  for (Estimate FilterScores::*estimate :
       {&FilterScores::psnr_db, &FilterScores::ssim, &FilterScores::edge_preservation, &FilterScores::iou}) {
    scores.*estimate = {0.5, 0.4, 0.6, 3};
  }
  scores.ghosts_removed = {ghosts, ghosts, ghosts, 3};
  return scores;
}

FilterReport report(double ghosts) {
  return {"set",
          "hash",
          2,
          3,
          {row("raw", "", ghosts), row("lee", "paper", ghosts), row("lee", "tuned", ghosts), row("mine", "", ghosts)}};
}

const ReportFigure* figure(const ReportPage& page, const std::string& title) {
  for (const ReportSection& section : page.sections) {
    const auto found = std::ranges::find(section.figures, title, &ReportFigure::title);
    if (found != section.figures.end()) return &*found;
  }
  return nullptr;
}

TEST(FilterPage, GhostsAreShownWhereThereAreAny) {
  EXPECT_EQ(figure(filter_page(report(none), {}, {}), "Ghosts removed"), nullptr);
  const ReportPage page = filter_page(report(0.25), {}, {});
  const ReportFigure* ghosts = figure(page, "Ghosts removed");
  ASSERT_NE(ghosts, nullptr);
  EXPECT_EQ(ghosts->tables.at(0).rows.at(1), (std::vector<std::string>{"lee", "paper", "0.250", "0.250", "0.250"}));
  EXPECT_EQ(page.sections.at(0).tables.at(0).columns.back(), "ghosts removed");
}

// A line a filter, a series a preset; marks of one filter beside each other, in the middle where there is one only.
TEST(FilterPage, PresetsStandBesideEachOther) {
  const ReportPage page = filter_page(report(none), {}, {});
  const Plot& plot = std::get<PlotSheet>(figure(page, "PSNR")->picture).plots.at(0);
  EXPECT_EQ(plot.categories, (std::vector<std::string>{"raw", "lee", "mine"}));
  ASSERT_EQ(plot.series.size(), 3U);
  EXPECT_EQ(plot.series[0].x, (std::vector<double>{0, 2}));
  EXPECT_EQ(plot.series[1].x.size(), 1U);
  EXPECT_LT(plot.series[1].x[0], 1);
  EXPECT_DOUBLE_EQ(plot.series[1].x[0] + plot.series[2].x[0], 2);
  EXPECT_EQ(plot.series[0].y_low, (std::vector<double>{0.4, 0.4}));
}

}  // namespace
}  // namespace ensonify
