#include "ensonify/generators/evaluate_maps.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>

#include "ensonify/core/error.hpp"
#include "ensonify/evaluation/map_picture.hpp"
#include "ensonify/generators/map_box.hpp"
#include "ensonify/generators/map_curve.hpp"

namespace ensonify {
namespace {

constexpr const char* name_of(MapPoses poses) { return poses == MapPoses::truth ? "true" : "drifted"; }

/// What is the same for all maps of a place.
struct JudgedPlace {
  PlacePings pings;
  MapTruth truth;  ///< of the box and a margin
  GridFrame box;   ///< what is mapped: observable cells, and all that the pings reach of the grid
  std::vector<std::string> models;
  std::array<Image2<std::uint8_t>, 2> seen;  ///< of the truth
};

std::vector<std::string> models_for(const Dataset& dataset, const PlacePings& pings, const MapEvaluation& what) {
  const bool elevations = has_elevations(dataset, pings);
  if (what.models.empty()) {
    std::vector<std::string> models{"points", "arc", "arc_shadow", "carve"};
    if (elevations) models.emplace_back("oracle");
    return models;
  }
  if (!elevations && std::ranges::find(what.models, "oracle") != what.models.end()) {
    throw DataError(
        fmt::format("{}: has no truth/*.exr for place {}, whose elevations the model oracle needs; generate "
                    "it from a recipe with truth: true, or leave oracle out",
                    dataset.folder.string(), pings.place));
  }
  return what.models;
}

JudgedPlace judged_place(const Dataset& dataset, const std::string& place, const MapEvaluation& what) {
  JudgedPlace judged{pings_of_place(dataset, what.split, place, what.max_frames), {}, {}, {}, {}};
  const auto grid = truth_of_place(dataset, place);
  const CellBox observable = grid && !grid->observable.empty() ? observable_box(*grid) : CellBox{};
  if (observable.empty()) {
    throw DataError(fmt::format("{}: grids/{}.npz is missing or has no observable cell; maps are scored there",
                                dataset.folder.string(), place));
  }
  CellBox box = observable;
  for (const MapPoses poses : what.poses) {
    const WorldBox reach = reach_of(judged.pings, poses);
    CellBox cells{grid->frame.cell_of(reach.low_m), grid->frame.cell_of(reach.high_m)};
    for (int& high : cells.high) ++high;
    box = hull(box, intersection(cells, box_of(grid->frame)));
  }
  const int margin = what.tolerances.back();
  CellBox wider = box;
  for (int a = 0; a < 3; ++a) {
    wider.low[a] = std::max(box.low[a] - margin, 0);
    wider.high[a] = std::min(box.high[a] + margin, grid->frame.size[a]);
  }
  judged.box = part_of(grid->frame, box);
  judged.truth = map_truth(cropped(*grid, wider), what.tolerances);
  judged.models = models_for(dataset, judged.pings, what);
  const LogOddsMap truth = map_of_truth(cropped(*grid, box));
  judged.seen = {seen_from_above(truth, {}, MapSide::free), seen_from_above(truth, {}, MapSide::occupied)};
  return judged;
}

/// Curves are told apart, and pooled, by their names.
void require_distinct(std::vector<std::string> names, const char* what) {
  std::ranges::sort(names);
  const auto twice = std::ranges::adjacent_find(names);
  if (twice != names.end()) throw ConfigError(fmt::format("{} '{}' is there twice; name each once", what, *twice));
}

ContactTile tile_of(const std::array<Image2<std::uint8_t>, 2>& seen, std::string caption) {
  constexpr int wanted = 260;
  const int side = std::max({1, seen[0].rows(), seen[0].columns()});
  const int factor = std::max(1, wanted / side);
  return {std::move(caption), {enlarged(seen[0], factor), enlarged(seen[1], factor)}};
}

/// All maps of one place.
ContactSheet evaluate_place(const Dataset& dataset, const MapEvaluation& what, const JudgedPlace& place,
                            const std::function<void()>& one_done, MapReport& report) {
  const bool oracle = std::ranges::find(place.models, "oracle") != place.models.end();
  const double for_maps = what.memory_bytes - bytes_of_pings(dataset, place.pings, oracle);
  const std::size_t last = what.tolerances.size() - 1;
  std::vector<double> thresholds(report.thresholds.begin(), report.thresholds.end());
  ContactSheet sheet{fmt::format("{} from above: left free, right occupied; bright observable cells, dim all others",
                                 place.pings.place),
                     {}};
  for (const MapFilter& filter : what.filters) {
    std::vector<PosedImage> pings = read_pings(dataset, place.pings, filter, MapPoses::truth, oracle, [] {});
    ContactRow row{filter.name, {tile_of(place.seen, "truth")}};
    for (const MapPoses poses : what.poses) {
      for (std::size_t i = 0; i < pings.size(); ++i) pings[i].T_world_sonar = place.pings.frames[i].pose(poses);
      for (const std::string& model : place.models) {
        ScoredMaps maps = score_maps(pings, inverse_model_named(model), thresholds, place.truth, place.box, for_maps);
        report.curves.push_back({place.pings.place, filter.name, model, name_of(poses), static_cast<int>(pings.size()),
                                 std::move(maps.counts)});
        const MapCurve& curve = report.curves.back();
        const std::size_t best = curve.best(last);
        if (poses == what.poses.front()) {
          row.tiles.push_back(tile_of(maps.seen[best], fmt::format("{}  t = {}  F1 = {:.2f}", model,
                                                                   report.thresholds[best], curve.at[best].f1(last))));
        }
        one_done();
      }
    }
    sheet.rows.push_back(std::move(row));
  }
  return sheet;
}

}  // namespace

MapEvaluationResult evaluate_maps(const Dataset& dataset, const MapEvaluation& what, const OnProgress& on_progress) {
  if (what.filters.empty() || what.poses.empty() || what.tolerances.empty()) {
    throw ConfigError("maps are evaluated for at least one filter, one kind of poses and one tolerance");
  }
  std::vector<std::string> filters;
  for (const MapFilter& filter : what.filters) filters.push_back(filter.name);
  require_distinct(filters, "filter");
  require_distinct(what.models, "model");
  MapEvaluationResult result;
  MapReport& report = result.report;
  report = {dataset.name, dataset.root_hash, what.split, {}, what.tolerances, what.fprs, {}};
  report.thresholds.resize(static_cast<std::size_t>(what.threshold_max) + 1);
  std::iota(report.thresholds.begin(), report.thresholds.end(), 0);
  const std::vector<std::string> places = what.places.empty() ? places_with_frames(dataset, what.split) : what.places;
  int done = 0;
  for (const std::string& name : places) {
    const JudgedPlace place = judged_place(dataset, name, what);
    const int maps = static_cast<int>(places.size() * what.filters.size() * what.poses.size() * place.models.size());
    const auto one_done = [&] { on_progress("maps", ++done, maps); };
    result.pictures.emplace_back(name, evaluate_place(dataset, what, place, one_done, report));
  }
  add_pooled_curves(report);
  return result;
}

}  // namespace ensonify
