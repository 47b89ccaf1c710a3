#include "ensonify/output/curve_table.hpp"

#include <limits>
#include <map>

namespace ensonify {

ReportTable curve_table(const Plot& plot, int x_digits, int y_digits) {
  constexpr double none = std::numeric_limits<double>::quiet_NaN();
  ReportTable table{"Numbers of the curves: " + plot.y_label, {plot.x_label}, {}, 1};
  std::map<double, std::vector<double>> lines;
  for (std::size_t s = 0; s < plot.series.size(); ++s) {
    const Series& series = plot.series[s];
    table.columns.push_back(series.name);
    for (std::size_t i = 0; i < series.x.size(); ++i) {
      auto& line = lines.try_emplace(series.x[i], plot.series.size(), none).first->second;
      line[s] = series.y[i];
    }
  }
  for (const auto& [x, values] : lines) {
    std::vector<std::string> row{fixed(x, x_digits)};
    for (const double value : values) row.push_back(fixed(value, y_digits));
    table.rows.push_back(std::move(row));
  }
  return table;
}

}  // namespace ensonify
