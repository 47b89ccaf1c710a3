#include "ensonify/evaluation/report_records.hpp"

#include <fmt/format.h>

#include <array>
#include <limits>
#include <nlohmann/json.hpp>

#include "ensonify/core/error.hpp"

namespace ensonify {
namespace {

using json = nlohmann::json;

constexpr std::array estimates{&FilterScores::psnr_db,
                               &FilterScores::ssim,
                               &FilterScores::edge_preservation,
                               &FilterScores::looks,
                               &FilterScores::gated_psnr_db,
                               &FilterScores::masked_psnr_db,
                               &FilterScores::masked_ssim,
                               &FilterScores::precision,
                               &FilterScores::recall,
                               &FilterScores::iou,
                               &FilterScores::f1,
                               &FilterScores::ghosts_removed};

constexpr std::array counts{&MapCounts::true_free,
                            &MapCounts::false_free,
                            &MapCounts::true_occupied,
                            &MapCounts::false_occupied,
                            &MapCounts::observable,
                            &MapCounts::observable_occupied,
                            &MapCounts::hidden_occupied_known,
                            &MapCounts::hidden_false_free,
                            &MapCounts::squared_error};

constexpr std::array tolerant_counts{&ToleranceCounts::right, &ToleranceCounts::found, &ToleranceCounts::false_free,
                                     &ToleranceCounts::false_occupied};

/// What is no number became null.
double number(const json& value) {
  return value.is_null() ? std::numeric_limits<double>::quiet_NaN() : value.get<double>();
}

json json_of(const FilterScores& row) {
  json entry{{"filter", row.filter},
             {"preset", row.preset},
             {"scene", row.scene},
             {"t", row.t},
             {"time_ms", row.time_ms},
             {"echo", row.levels.echo},
             {"background", row.levels.background}};
  for (const auto estimate : estimates) {
    const Estimate& e = row.*estimate;
    entry["estimates"].push_back({e.value, e.low, e.high, e.frames});
  }
  return entry;
}

FilterScores scores_of(const json& entry) {
  FilterScores row;
  row.filter = entry.at("filter");
  row.preset = entry.at("preset");
  row.scene = entry.at("scene");
  row.t = entry.at("t");
  row.time_ms = number(entry.at("time_ms"));
  row.levels.echo = entry.at("echo");
  row.levels.background = entry.at("background");
  for (std::size_t i = 0; i < estimates.size(); ++i) {
    const json& e = entry.at("estimates").at(i);
    row.*estimates[i] = {number(e.at(0)), number(e.at(1)), number(e.at(2)), e.at(3).get<int>()};
  }
  return row;
}

json json_of(const MapCurve& curve) {
  json entry{{"scene", curve.scene},
             {"filter", curve.filter},
             {"model", curve.model},
             {"poses", curve.poses},
             {"frames", curve.frames}};
  for (const MapCounts& at : curve.at) {
    json line;
    for (const auto count : counts) line.push_back(at.*count);
    for (const ToleranceCounts& tolerant : at.tolerant) {
      for (const auto count : tolerant_counts) line.push_back(tolerant.*count);
    }
    entry["at"].push_back(std::move(line));
  }
  return entry;
}

MapCurve curve_of(const json& entry, std::size_t tolerances) {
  MapCurve curve{entry.at("scene"), entry.at("filter"), entry.at("model"), entry.at("poses"), entry.at("frames"), {}};
  for (const json& line : entry.at("at")) {
    std::size_t column = 0;
    MapCounts at;
    for (const auto count : counts) at.*count = line.at(column++);
    at.tolerant.resize(tolerances);
    for (ToleranceCounts& tolerant : at.tolerant) {
      for (const auto count : tolerant_counts) tolerant.*count = line.at(column++);
    }
    curve.at.push_back(std::move(at));
  }
  return curve;
}

template <typename Report, typename Read>
Report read_record(std::string_view record, const std::filesystem::path& from, const Read& read) {
  try {
    return read(json::parse(record));
  } catch (const json::exception& e) {
    throw DataError(
        fmt::format("{}: is no whole record ({}); delete it, and it is made anew", from.string(), e.what()));
  }
}

}  // namespace

std::string record_of(const FilterReport& report) {
  json root{{"dataset", report.dataset},
            {"root_hash", report.root_hash},
            {"val_frames", report.val_frames},
            {"test_frames", report.test_frames},
            {"rows", json::array()}};
  for (const FilterScores& row : report.rows) root["rows"].push_back(json_of(row));
  return root.dump(-1, ' ', false, json::error_handler_t::replace) + "\n";
}

std::string record_of(const MapReport& report) {
  json root{{"dataset", report.dataset},       {"root_hash", report.root_hash},   {"split", report.split},
            {"thresholds", report.thresholds}, {"tolerances", report.tolerances}, {"fprs", report.fprs},
            {"curves", json::array()}};
  for (const MapCurve& curve : report.curves) root["curves"].push_back(json_of(curve));
  return root.dump(-1, ' ', false, json::error_handler_t::replace) + "\n";
}

FilterReport filter_report_of(std::string_view record, const std::filesystem::path& from) {
  return read_record<FilterReport>(record, from, [](const json& root) {
    FilterReport report{root.at("dataset"), root.at("root_hash"), root.at("val_frames"), root.at("test_frames"), {}};
    for (const json& row : root.at("rows")) report.rows.push_back(scores_of(row));
    return report;
  });
}

MapReport map_report_of(std::string_view record, const std::filesystem::path& from) {
  return read_record<MapReport>(record, from, [](const json& root) {
    MapReport report{root.at("dataset"),
                     root.at("root_hash"),
                     root.at("split"),
                     root.at("thresholds"),
                     root.at("tolerances"),
                     root.at("fprs"),
                     {}};
    for (const json& curve : root.at("curves")) report.curves.push_back(curve_of(curve, report.tolerances.size()));
    return report;
  });
}

}  // namespace ensonify
