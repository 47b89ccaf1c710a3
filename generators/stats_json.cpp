#include "ensonify/generators/stats_json.hpp"

#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <numeric>

namespace ensonify {
namespace {

using json = nlohmann::ordered_json;

json to_json(const Histogram& h) { return {{"low", h.low}, {"high", h.high}, {"counts", h.counts}}; }

json to_json(const Summary& s) {
  json entry{{"count", s.count}};
  if (s.count > 0)
    entry.update({{"min", s.min}, {"mean", s.mean}, {"max", s.max}, {"histogram", to_json(s.histogram)}});
  return entry;
}

json to_json(const std::map<std::string, Summary>& summaries) {
  json entries = json::object();
  for (const auto& [key, summary] : summaries) entries[key] = to_json(summary);
  return entries;
}

json mask_share_json(const Figures& f) {
  json entry = to_json(f.mask_share);
  for (std::size_t i = 0; i < mask_share_percents.size(); ++i) {
    entry["percentiles"][std::to_string(mask_share_percents[i])] = f.mask_share_percentiles[i];
  }
  entry[fmt::format("below_{}", sparse_mask_share)] = f.mask_share_below;
  entry[fmt::format("above_{}", crowded_mask_share)] = f.mask_share_above;
  return entry;
}

json labels_json(const PixelSums& sums) {
  constexpr std::array<const char*, label_count> names{"water", "direct", "multipath", "sidelobe", "shadow", "outside"};
  const auto total = std::accumulate(sums.labels.begin(), sums.labels.end(), std::uint64_t{0});
  json entry;
  for (std::size_t i = 0; i < names.size(); ++i) {
    entry[names[i]] = static_cast<double>(sums.labels[i]) / static_cast<double>(total);
  }
  return entry;
}

json range_json(const PixelSums& sums, const RangeBins& bins) {
  json level = json::array(), share = json::array();
  for (std::size_t i = 0; i < sums.bin_pixels.size(); ++i) {
    const auto pixels = static_cast<double>(sums.bin_pixels[i]);
    const bool none = sums.bin_pixels[i] == 0;  // no frame's window reaches there
    level.push_back(none ? json(nullptr) : json(static_cast<double>(sums.bin_raw[i]) / 257 / pixels));
    share.push_back(none ? json(nullptr) : json(static_cast<double>(sums.bin_mask[i]) / pixels));
  }
  return {{"range_min_m", bins.min_m}, {"range_max_m", bins.max_m}, {"raw_level", level}, {"mask_share", share}};
}

json to_json(const Figures& f, const RangeBins& bins) {
  json entry{{"frames", f.frames}, {"frames_read", f.frames_read}};
  if (f.frames_read > 0) {
    entry["without_echo"] = static_cast<double>(f.pixels.without_echo) / f.frames_read;
    entry["mask_share"] = mask_share_json(f);
    entry["label_share"] = labels_json(f.pixels);
    entry["raw_histogram"] = f.pixels.raw;
    entry["clean_histogram"] = f.pixels.clean;
    entry["range"] = range_json(f.pixels, bins);
  }
  entry["poses"] = to_json(f.poses);
  entry["sampled"] = to_json(f.sampled);
  return entry;
}

json to_json(const TrainVariety& train) {
  const Variety& v = train.variety;
  json entry{{"split", "train"},
             {"image", "clean"},
             {"method", "DCT hash (Zauner 2010) of 32 x 32 cells of log(1 + grey), then correlation of the cells"},
             {"hash_distance_at_most", near_hash_distance},
             {"correlation_above", near_correlation},
             {"frames", v.frames},
             {"blank_frames", v.blank},
             {"near_pairs", v.pairs},
             {"frames_in_near_pairs", v.frames_in_pairs},
             {"complete", v.complete},
             {"closest", json::array()}};
  for (const TrainVariety::Pair& pair : train.closest) {
    entry["closest"].push_back({{"a", fmt::format("train/clean/{:06}.png", pair.a)},
                                {"b", fmt::format("train/clean/{:06}.png", pair.b)},
                                {"place_a", pair.place_a},
                                {"place_b", pair.place_b},
                                {"hash_distance", pair.distance},
                                {"correlation", pair.correlation},
                                {"apart_m", pair.apart_m},
                                {"turned_deg", pair.turned_deg}});
  }
  return entry;
}

}  // namespace

std::string stats_json(const DatasetStats& stats) {
  json root{{"schema", "ensonify-stats"},
            {"schema_version", 1},
            {"tool", {{"name", "ensonify"}, {"version", ENSONIFY_VERSION}}},
            {"dataset",
             {{"name", stats.name}, {"title", stats.title}, {"format", stats.format}, {"root_hash", stats.root_hash}}}};
  root["overall"] = to_json(stats.overall, stats.bins);
  for (const auto& [split, figures] : stats.splits) root["splits"][split] = to_json(figures, stats.bins);
  root["places"] = json::object();
  root["scenes"] = json::object();
  root["never_seen"] = json::array();
  for (const PlaceFigures& place : stats.places) {
    json entry{{"split", place.split}, {"scene", place.place.scene}, {"layout", place.place.layout}};
    if (place.way) {
      entry["trajectory"] = {{"duration_s", place.way->duration_s},
                             {"length_m", place.way->length_m},
                             {"drift_at_end_m", place.way->drift_m}};
    }
    entry.update(to_json(place.figures, stats.bins));
    root["places"][place.place.name] = std::move(entry);
    json& frames = root["scenes"][place.place.scene];
    frames = place.figures.frames + (frames.is_null() ? 0 : frames.get<int>());
    if (place.figures.frames == 0) root["never_seen"].push_back(place.place.name);
  }
  root["variety"] = stats.variety ? to_json(*stats.variety) : json(nullptr);
  return root.dump(1) + "\n";
}

}  // namespace ensonify
