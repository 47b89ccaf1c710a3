#include <fmt/format.h>

#include <algorithm>

#include "ensonify/evaluation/map_report.hpp"

namespace ensonify {
namespace {

Plot over_threshold(const MapReport& report, const std::vector<const MapCurve*>& curves, const std::string& title,
                    const char* unit, double (*value)(const MapCounts&, std::size_t), std::size_t tolerance) {
  Plot plot = titled_plot(title, "threshold t [grey level]", unit);
  for (const MapCurve* curve : curves) {
    Series series{curve->filter, {}, {}};
    for (std::size_t i = 0; i < curve->at.size(); ++i) {
      series.x.push_back(report.thresholds[i]);
      series.y.push_back(value(curve->at[i], tolerance));
    }
    plot.series.push_back(std::move(series));
  }
  plot.y_range = {{0.0, 1.0}};
  return plot;
}

}  // namespace

std::vector<ModelPlots> model_plots(const MapReport& report, const std::string& scene, const std::string& poses) {
  std::vector<std::string> models;
  for (const MapCurve& curve : report.curves) {
    if (std::ranges::find(models, curve.model) == models.end()) models.push_back(curve.model);
  }
  const std::size_t last = report.tolerances.size() - 1;
  std::vector<ModelPlots> result;
  for (const std::string& model : models) {
    std::vector<const MapCurve*> curves;
    for (const MapCurve& curve : report.curves) {
      if (curve.model == model && curve.scene == scene && curve.poses == poses) curves.push_back(&curve);
    }
    const auto plot = [&](const std::string& what, const char* unit, double (*value)(const MapCounts&, std::size_t)) {
      return over_threshold(report, curves, model + ": " + what, unit, value, last);
    };
    result.push_back(
        {model, plot("occupied cells called free", "FPR", [](const MapCounts& n, std::size_t) { return n.fpr(); }),
         plot("free cells called occupied", "FNR", [](const MapCounts& n, std::size_t) { return n.fnr(); }),
         plot("cells called right", "balanced accuracy",
              [](const MapCounts& n, std::size_t) { return n.balanced_accuracy(); }),
         plot("known share of observable cells", "coverage",
              [](const MapCounts& n, std::size_t) { return n.coverage(); }),
         plot(fmt::format("occupied, {} cell tolerance", report.tolerances[last]), "F1",
              [](const MapCounts& n, std::size_t i) { return n.f1(i); })});
  }
  return result;
}

PlotSheet map_plots(const MapReport& report, const std::string& scene, const std::string& poses) {
  PlotSheet sheet;
  std::vector<ModelPlots> models = model_plots(report, scene, poses);
  for (ModelPlots& of : models) {
    for (Plot* plot : {&of.fpr, &of.fnr, &of.coverage, &of.f1}) sheet.plots.push_back(std::move(*plot));
  }
  sheet.columns = 4;
  sheet.width = 2000;
  sheet.height = 380 * static_cast<int>(models.size());
  return sheet;
}

}  // namespace ensonify
