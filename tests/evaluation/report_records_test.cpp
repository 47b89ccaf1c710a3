#include "ensonify/evaluation/report_records.hpp"

#include <gtest/gtest.h>

#include <limits>

#include "ensonify/core/error.hpp"

namespace ensonify {
namespace {

constexpr double no_number = std::numeric_limits<double>::quiet_NaN();

FilterReport filter_report() {
  FilterScores row;
  row.filter = "lee \"enhanced\"";
  row.preset = "paper";
  row.scene = "all";
  row.t = 17;
  row.psnr_db = {23.1234567890123456, 1.0 / 3.0, 1e-300, 40};
  row.ghosts_removed = {no_number, no_number, no_number, 0};
  row.iou = {0.9, 0.8, 1.0, 39};
  row.time_ms = 0.1;
  row.levels.echo[255] = std::numeric_limits<std::uint64_t>::max();
  row.levels.background[0] = 3;
  return {"set", "abc", 20, 40, {row}};
}

MapReport map_report() {
  MapCounts at;
  at.true_free = 5;
  at.false_occupied = 1;
  at.observable = 9;
  at.squared_error = std::numeric_limits<std::uint64_t>::max();
  at.tolerant = {{1, 2, 3, 4}, {5, 6, 7, 8}};
  return {"set", "abc", "test", {0, 1}, {0, 2}, {0.01, 0.1}, {{"dam", "raw", "points", "true", 10, {at, {}}}}};
}

TEST(ReportRecords, FilterReportsComeBackToTheBit) {
  const FilterReport report = filter_report(), back = filter_report_of(record_of(report), "record");
  EXPECT_EQ(record_of(back), record_of(report));
  EXPECT_EQ(scores_json(back), scores_json(report));
  EXPECT_EQ(times_csv(back), times_csv(report));
  ASSERT_EQ(back.rows.size(), 1U);
  EXPECT_EQ(back.rows[0].psnr_db.value, report.rows[0].psnr_db.value);
  EXPECT_EQ(back.rows[0].psnr_db.low, report.rows[0].psnr_db.low);
  EXPECT_EQ(back.rows[0].iou.frames, 39);
  EXPECT_TRUE(std::isnan(back.rows[0].ghosts_removed.value));
  EXPECT_EQ(back.rows[0].levels.echo, report.rows[0].levels.echo);
  EXPECT_EQ(back.rows[0].levels.background, report.rows[0].levels.background);
}

TEST(ReportRecords, MapReportsComeBackToTheBit) {
  MapReport report = map_report();
  report.curves[0].at[1].tolerant.resize(2);
  const MapReport back = map_report_of(record_of(report), "record");
  EXPECT_EQ(record_of(back), record_of(report));
  EXPECT_EQ(map_scores_csv(back), map_scores_csv(report));
  EXPECT_EQ(map_scores_json(back), map_scores_json(report));
  EXPECT_EQ(back.curves.at(0).at.at(0).tolerant.at(1).false_occupied, 8U);
}

TEST(ReportRecords, NamesOfChainsAreFree) {
  FilterReport report = filter_report();
  report.rows[0].filter = "a, \"b\"";
  EXPECT_NE(scores_csv(report).find("\n\"a, \"\"b\"\"\",paper,all,40,17,"), std::string::npos) << scores_csv(report);
  EXPECT_NE(times_csv(report).find("\n\"a, \"\"b\"\"\",paper,all,"), std::string::npos);
  MapReport maps = map_report();
  maps.curves[0].at.resize(1);
  maps.curves[0].filter = "a,b";
  EXPECT_NE(map_scores_csv(maps).find("\ndam,\"a,b\",points,true,0,"), std::string::npos);
  EXPECT_NE(map_summary_csv(maps).find("\ndam,\"a,b\",points,true,10,"), std::string::npos);
}

TEST(ReportRecords, WhatIsNoneIsRefusedByName) {
  const std::string whole = record_of(filter_report());
  for (const std::string& text : {std::string(), whole.substr(0, whole.size() / 2), std::string("[]"),
                                  std::string("{\"dataset\": 3}"), record_of(map_report())}) {
    try {
      filter_report_of(text, "kept/filters.json");
      FAIL() << text.substr(0, 60);
    } catch (const DataError& e) {
      EXPECT_NE(std::string(e.what()).find("kept/filters.json: is no whole record"), std::string::npos) << e.what();
    }
  }
  EXPECT_THROW(map_report_of(whole, "x"), DataError);
}

}  // namespace
}  // namespace ensonify
