#include "ensonify/evaluation/map_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <nlohmann/json.hpp>
#include <tuple>

#include "ensonify/evaluation/csv_field.hpp"
#include "ensonify/evaluation/map_summary.hpp"

namespace ensonify {
namespace {

using json = nlohmann::ordered_json;

/// A column of the table over thresholds.
struct Column {
  std::string name;
  std::function<double(const MapCounts&)> value;
};

std::vector<Column> columns_of(const MapReport& report) {
  std::vector<Column> columns{
      {"fpr", &MapCounts::fpr},
      {"fnr", &MapCounts::fnr},
      {"fp_share", &MapCounts::fp_share},
      {"fn_share", &MapCounts::fn_share},
      {"coverage", &MapCounts::coverage},
      {"balanced_accuracy", &MapCounts::balanced_accuracy},
      {"iou", &MapCounts::iou},
      {"brier", &MapCounts::brier},
      {"brier_observable", &MapCounts::brier_observable},
  };
  for (std::size_t i = 0; i < report.tolerances.size(); ++i) {
    const int k = report.tolerances[i];
    columns.push_back({fmt::format("precision_k{}", k), [i](const MapCounts& n) { return n.precision(i); }});
    columns.push_back({fmt::format("recall_k{}", k), [i](const MapCounts& n) { return n.recall(i); }});
    columns.push_back({fmt::format("f1_k{}", k), [i](const MapCounts& n) { return n.f1(i); }});
    if (k == 0) continue;
    columns.push_back({fmt::format("fpr_k{}", k), [i](const MapCounts& n) { return n.tolerant_fpr(i); }});
    columns.push_back({fmt::format("fnr_k{}", k), [i](const MapCounts& n) { return n.tolerant_fnr(i); }});
  }
  return columns;
}

struct RawCount {
  const char* name;
  std::uint64_t MapCounts::*count;
};

constexpr std::array raw_counts{RawCount{"tp", &MapCounts::true_free},
                                RawCount{"fp", &MapCounts::false_free},
                                RawCount{"tn", &MapCounts::true_occupied},
                                RawCount{"fn", &MapCounts::false_occupied},
                                RawCount{"observable", &MapCounts::observable},
                                RawCount{"observable_occupied", &MapCounts::observable_occupied},
                                RawCount{"hidden_occupied_known", &MapCounts::hidden_occupied_known},
                                RawCount{"hidden_false_free", &MapCounts::hidden_false_free}};

std::string number(double value) { return std::isfinite(value) ? fmt::format("{:.6g}", value) : ""; }
json value_of(double value) { return std::isfinite(value) ? json(value) : json(nullptr); }

std::string names_of(const MapCurve& c) {
  return fmt::format("{},{},{},{}", csv_field(c.scene), csv_field(c.filter), c.model, c.poses);
}

json json_of(const MapReport& report, const MapCurve& curve) {
  json entry{{"scene", curve.scene},
             {"filter", curve.filter},
             {"model", curve.model},
             {"poses", curve.poses},
             {"frames", curve.frames}};
  json& summary = entry["summary"];
  for (const auto& [name, value] : summary_of(report, curve)) summary[name] = value_of(value);
  for (const RawCount& raw : raw_counts) {
    for (const MapCounts& n : curve.at) entry["counts"][raw.name].push_back(n.*raw.count);
  }
  for (const Column& column : columns_of(report)) {
    for (const MapCounts& n : curve.at) entry["over_threshold"][column.name].push_back(value_of(column.value(n)));
  }
  return entry;
}

}  // namespace

std::size_t MapCurve::best(std::size_t tolerance) const {
  std::size_t found = 0;
  for (std::size_t i = 1; i < at.size(); ++i) {
    const double f1 = at[i].f1(tolerance);
    if (f1 > at[found].f1(tolerance) || (std::isnan(at[found].f1(tolerance)) && !std::isnan(f1))) found = i;
  }
  return found;
}

void add_pooled_curves(MapReport& report) {
  std::vector<MapCurve> pooled;
  for (const MapCurve& curve : report.curves) {
    const auto same = [&](const MapCurve& other) {
      return std::tie(curve.filter, curve.model, curve.poses) == std::tie(other.filter, other.model, other.poses);
    };
    auto found = std::ranges::find_if(pooled, same);
    if (found == pooled.end()) {
      pooled.push_back({"all", curve.filter, curve.model, curve.poses, 0, std::vector<MapCounts>(curve.at.size())});
      found = pooled.end() - 1;
    }
    found->frames += curve.frames;
    for (std::size_t i = 0; i < curve.at.size(); ++i) found->at[i] += curve.at[i];
  }
  report.curves.insert(report.curves.end(), pooled.begin(), pooled.end());
}

std::string map_scores_csv(const MapReport& report) {
  const std::vector<Column> columns = columns_of(report);
  std::string text = "scene,filter,model,poses,threshold";
  for (const RawCount& raw : raw_counts) text += fmt::format(",{}", raw.name);
  for (const Column& c : columns) text += fmt::format(",{}", c.name);
  text += "\n";
  for (const MapCurve& curve : report.curves) {
    for (std::size_t i = 0; i < curve.at.size(); ++i) {
      text += fmt::format("{},{}", names_of(curve), report.thresholds.at(i));
      for (const RawCount& raw : raw_counts) text += fmt::format(",{}", curve.at[i].*raw.count);
      for (const Column& c : columns) text += fmt::format(",{}", number(c.value(curve.at[i])));
      text += "\n";
    }
  }
  return text;
}

std::string map_summary_csv(const MapReport& report) {
  std::string text;
  for (const MapCurve& curve : report.curves) {
    const auto summary = summary_of(report, curve);
    if (text.empty()) {
      text = "scene,filter,model,poses,frames";
      for (const auto& [name, value] : summary) text += fmt::format(",{}", name);
      text += "\n";
    }
    text += fmt::format("{},{}", names_of(curve), curve.frames);
    for (const auto& [name, value] : summary) text += fmt::format(",{}", number(value));
    text += "\n";
  }
  return text;
}

std::string map_scores_json(const MapReport& report) {
  json root{{"schema", "ensonify-map-scores"},
            {"schema_version", 1},
            {"dataset", report.dataset},
            {"root_hash", report.root_hash},
            {"split", report.split},
            {"positive", "free"},
            {"cells", "observable cells of the truth grid; unknown cells count in coverage, recall, IoU and F1 only"},
            {"thresholds", report.thresholds},
            {"tolerances_cells", report.tolerances},
            {"curves", json::array()}};
  for (const MapCurve& curve : report.curves) root["curves"].push_back(json_of(report, curve));
  return root.dump(-1, ' ', false, json::error_handler_t::replace) + "\n";
}

}  // namespace ensonify
