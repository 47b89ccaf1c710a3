#include "ensonify/generators/dataset_stats.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "ensonify/generators/image_figures.hpp"

namespace ensonify {
namespace {

constexpr int summary_bins = 32;
constexpr int closest_pairs = 20;
using Columns = std::map<std::string, std::vector<double>>;

/// Least and greatest of every column over all places, so that histograms can be compared.
struct Edges {
  std::map<std::string, std::pair<double, double>> of;
  std::set<std::string> broken;  ///< keys of which some value is not a whole number

  void add(const Columns& columns) {
    for (const auto& [key, values] : columns) {
      const auto [min, max] = std::minmax_element(values.begin(), values.end());
      const auto whole = [](double v) { return v == std::round(v); };
      if (!std::all_of(values.begin(), values.end(), whole)) broken.insert(key);
      const auto [at, fresh] = of.try_emplace(key, *min, *max);
      if (!fresh) at->second = {std::min(at->second.first, *min), std::max(at->second.second, *max)};
    }
  }
};

/// Steps for whole numbers hold equally many of them each: others would show gaps that are not there.
struct Steps {
  double low = 0, high = 0;
  int bins = summary_bins;
};

Steps steps_of(double low, double high, bool whole) {
  if (!whole || high - low > 1e6) return {low, high, summary_bins};
  const int values = static_cast<int>(high - low) + 1;
  const int each = (values + summary_bins - 1) / summary_bins;
  const int bins = (values + each - 1) / each;
  return {low - 0.5, low - 0.5 + bins * each, bins};
}

std::map<std::string, Summary> summaries(const Columns& columns, const Edges& edges) {
  std::map<std::string, Summary> result;
  for (const auto& [key, values] : columns) {
    const auto [low, high] = edges.of.at(key);
    const Steps steps = steps_of(low, high, !edges.broken.contains(key));
    result[key] = summarise(values, steps.low, steps.high, steps.bins);
  }
  return result;
}

/// Joins what places have into the figures of a split or of all.
class Joiner {
 public:
  Joiner(const DatasetSurvey& survey, const std::vector<std::vector<bool>>& taken, const ImageFigures& images)
      : survey_(survey), taken_(taken), images_(images) {
    for (const PlaceFrames& place : survey.places) {
      poses_.add(place.poses);
      sampled_.add(place.sampled);
    }
    for (std::size_t s = 0; s < taken.size(); ++s) {
      for (std::size_t n = 0; n < taken[s].size(); ++n) {
        if (taken[s][n]) most_share_ = std::max(most_share_, images.mask_share[s][n]);
      }
    }
  }

  template <typename Belongs>
  Figures of_places(const Belongs& belongs) const {
    Figures figures;
    Columns poses, sampled;
    std::vector<double> shares;
    for (std::size_t p = 0; p < survey_.places.size(); ++p) {
      const PlaceFrames& place = survey_.places[p];
      if (!belongs(p)) continue;
      figures.frames += static_cast<int>(place.numbers.size());
      figures.pixels += images_.sums[p];
      for (const auto& [key, v] : place.poses) poses[key].insert(poses[key].end(), v.begin(), v.end());
      for (const auto& [key, v] : place.sampled) sampled[key].insert(sampled[key].end(), v.begin(), v.end());
      const auto split = static_cast<std::size_t>(place.split);
      for (const int number : place.numbers) {
        const auto n = static_cast<std::size_t>(number);
        if (taken_[split][n]) shares.push_back(images_.mask_share[split][n]);
      }
    }
    figures.frames_read = static_cast<int>(shares.size());
    figures.poses = summaries(poses, poses_);
    figures.sampled = summaries(sampled, sampled_);
    add_mask_shares(std::move(shares), figures);
    return figures;
  }

 private:
  void add_mask_shares(std::vector<double> shares, Figures& figures) const {
    std::sort(shares.begin(), shares.end());
    figures.mask_share = summarise(shares, 0, most_share_, summary_bins);
    for (std::size_t i = 0; i < mask_share_percents.size(); ++i) {
      figures.mask_share_percentiles[i] = percentile(shares, mask_share_percents[i]);
    }
    if (shares.empty()) return;
    const auto n = static_cast<double>(shares.size());
    const auto below = std::lower_bound(shares.begin(), shares.end(), sparse_mask_share) - shares.begin();
    const auto above = shares.end() - std::upper_bound(shares.begin(), shares.end(), crowded_mask_share);
    figures.mask_share_below = static_cast<double>(below) / n;
    figures.mask_share_above = static_cast<double>(above) / n;
  }

  const DatasetSurvey& survey_;
  const std::vector<std::vector<bool>>& taken_;
  const ImageFigures& images_;
  Edges poses_, sampled_;
  double most_share_ = 0;
};

TrainVariety variety_of(const DatasetSurvey& survey, const MetadataIndex& metadata, const ImageFigures& images) {
  const auto split = static_cast<std::size_t>(metadata.split);
  const std::vector<int>& numbers = images.train_numbers;
  TrainVariety result{find_near_pairs(images.train_thumbnails, closest_pairs), {}};
  for (const NearPair& pair : result.variety.closest) {
    const int a = numbers[static_cast<std::size_t>(pair.a)], b = numbers[static_cast<std::size_t>(pair.b)];
    const Pose T_world_a = read_frames(metadata, a, 1).front().T_world_sonar;
    const Pose T_world_b = read_frames(metadata, b, 1).front().T_world_sonar;
    const auto place = [&](int number) {
      return survey.places[static_cast<std::size_t>(survey.place_of[split][static_cast<std::size_t>(number)])]
          .place.name;
    };
    const Eigen::AngleAxisd turn(T_world_a.rotation().transpose() * T_world_b.rotation());
    result.closest.push_back({a, b, pair.distance, pair.correlation, place(a), place(b),
                              (T_world_a.translation() - T_world_b.translation()).norm(), degrees(turn.angle())});
  }
  return result;
}

ContactSheet sheet_of(const DatasetSurvey& survey, ImageFigures& images, std::size_t split, const std::string& name) {
  ContactSheet sheet{name + ": raw and mask, range downwards", {}};
  for (std::size_t p = 0; p < survey.places.size(); ++p) {
    const PlaceFrames& place = survey.places[p];
    if (static_cast<std::size_t>(place.split) != split || images.tiles[p].empty()) continue;
    ContactRow row{fmt::format("{}   {} frames", place.place.name, place.numbers.size()), {}};
    for (auto& [number, tile] : images.tiles[p]) row.tiles.push_back(std::move(tile));
    sheet.rows.push_back(std::move(row));
  }
  return sheet;
}

}  // namespace

DatasetStats dataset_stats(const Dataset& dataset, const StatsOptions& options,
                           const std::function<void(int, int)>& on_progress) {
  std::vector<MetadataIndex> metadata;
  for (std::size_t s = 0; s < dataset.splits.size(); ++s) {
    metadata.push_back(index_metadata(dataset, static_cast<int>(s)));
  }
  const DatasetSurvey survey = survey_metadata(dataset, metadata);
  const auto taken = spread_frames(survey, options.max_frames);

  ImageFigures images = read_images(dataset, survey, metadata, taken, options.contact_columns, on_progress);

  DatasetStats stats;
  stats.name = dataset.name;
  stats.title = dataset.title;
  stats.root_hash = dataset.root_hash;
  stats.format = dataset.format == SampleFormat::folder ? "folder" : "webdataset";
  stats.bins = survey.bins;
  const Joiner joiner(survey, taken, images);
  stats.overall = joiner.of_places([](std::size_t) { return true; });
  for (std::size_t s = 0; s < taken.size(); ++s) {
    const auto in_split = [&](std::size_t p) { return static_cast<std::size_t>(survey.places[p].split) == s; };
    stats.splits.emplace_back(dataset.splits[s].name, joiner.of_places(in_split));
    if (options.contact_columns > 0) {
      stats.contact_sheets.emplace_back(dataset.splits[s].name, sheet_of(survey, images, s, dataset.splits[s].name));
    }
    if (dataset.splits[s].name == "train") {
      stats.variety = variety_of(survey, metadata[s], images);
    }
  }
  for (std::size_t p = 0; p < survey.places.size(); ++p) {
    const PlaceFrames& place = survey.places[p];
    stats.places.push_back({place.place, dataset.splits[static_cast<std::size_t>(place.split)].name,
                            joiner.of_places([&](std::size_t other) { return other == p; }), place.way});
  }
  return stats;
}

}  // namespace ensonify
