#include "ensonify/generators/explore_files.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <nlohmann/json.hpp>

#include "ensonify/core/error.hpp"
#include "ensonify/mapping/map_conversion.hpp"
#include "ensonify/output/map_files.hpp"
#include "ensonify/output/npz.hpp"

namespace ensonify {
namespace {

using Field = std::pair<std::string, double>;

void add_pose(std::vector<Field>& fields, const std::string& prefix, const Pose& pose) {
  const auto angles = roll_pitch_yaw(pose);
  const std::array<const char*, 3> axes{"x_m", "y_m", "z_m"};
  const std::array<const char*, 3> turns{"roll_deg", "pitch_deg", "yaw_deg"};
  for (int i = 0; i < 3; ++i) fields.emplace_back(prefix + axes[i], pose.translation()[i]);
  for (int i = 0; i < 3; ++i) fields.emplace_back(prefix + turns[i], degrees(angles[i]));
}

std::vector<Field> fields_of(const ExploreStep& s) {
  std::vector<Field> fields{{"step", s.step}, {"time_s", s.time_s}};
  add_pose(fields, "", s.T_world_sonar);
  add_pose(fields, "est_", s.T_world_sonar_est);
  fields.insert(fields.end(), {{"coverage", s.scores.coverage},
                               {"boundary_found", s.scores.boundary_found},
                               {"fpr", s.scores.fpr},
                               {"fnr", s.scores.fnr},
                               {"clearance_m", s.clearance_m},
                               {"path_m", s.path_m}});
  return fields;
}

/// Six decimals; -0 is 0.
std::string number(double value) {
  if (std::isnan(value)) return "nan";
  const double rounded = std::round(value * 1e6) / 1e6;
  return fmt::format("{}", rounded == 0 ? 0.0 : rounded);
}

nlohmann::json or_null(double value) { return std::isnan(value) ? nlohmann::json() : nlohmann::json(value); }

std::size_t cells_of(const NpyArray& array) {
  std::size_t cells = 1;
  for (const std::size_t n : array.shape) cells *= n;
  return cells;
}

std::vector<double> numbers_of(const NpyArray& array, const std::string& name) {
  std::vector<double> values(cells_of(array));
  const auto read = [&]<typename T>(T) {
    std::vector<T> raw(values.size());
    if (array.bytes.size() != raw.size() * sizeof(T)) throw DataError(fmt::format("{}: is cut short", name));
    std::memcpy(raw.data(), array.bytes.data(), array.bytes.size());
    std::ranges::transform(raw, values.begin(), [](T v) { return static_cast<double>(v); });
  };
  if (array.descr == "<f4")
    read(float{});
  else if (array.descr == "<f8")
    read(double{});
  else if (array.descr == "|u1")
    read(std::uint8_t{});
  else
    throw DataError(fmt::format("{}: is of type {}; must be float32, float64 or uint8", name, array.descr));
  return values;
}

/// Values are kept as far as columns_of() looks at them: by their sign.
LogOddsMap read_cells(const std::filesystem::path& path) {
  const auto arrays = read_npz(path);
  const auto get = [&](const std::string& key) {
    const auto found = arrays.find(key);
    if (found == arrays.end()) {
      throw DataError(fmt::format(
          "{}: has no array {}; a map has log_odds [z, y, x] (or occupancy and observable), origin [3], resolution",
          path.string(), key));
    }
    return numbers_of(found->second, fmt::format("{}: {}", path.string(), key));
  };
  const std::string values = arrays.contains("log_odds") ? "log_odds" : "occupancy";
  std::vector<double> value = get(values);
  const std::vector<double> origin = get("origin");
  const std::vector<double> resolution = get("resolution");
  const std::vector<std::size_t>& shape = arrays.at(values).shape;
  const bool sane = shape.size() == 3 && origin.size() == 3 && resolution.size() == 1 && resolution[0] > 0 &&
                    std::isfinite(resolution[0]) &&
                    std::ranges::all_of(shape, [](std::size_t n) { return n > 0 && n < 1u << 30; }) &&
                    std::ranges::all_of(origin, [](double v) { return std::isfinite(v); }) &&
                    std::ranges::none_of(value, [](double v) { return std::isnan(v); });
  if (!sane) {
    throw DataError(fmt::format("{}: {} must be [z, y, x] of numbers, origin three, resolution one above 0",
                                path.string(), values));
  }
  LogOddsMap cells{{{origin[0], origin[1], origin[2]},
                    resolution[0],
                    {static_cast<int>(shape[2]), static_cast<int>(shape[1]), static_cast<int>(shape[0])}},
                   {}};
  if (values == "occupancy") {
    const std::vector<double> observable = get("observable");
    if (observable.size() != value.size()) {
      throw DataError(fmt::format("{}: occupancy and observable differ in size", path.string()));
    }
    for (std::size_t i = 0; i < observable.size(); ++i) {
      value[i] = observable[i] == 0 ? 0.0 : value[i] != 0 ? 1.0 : -1.0;
    }
  }
  for (const double v : value) cells.log_odds.push_back(v > 0 ? 1.0F : v < 0 ? -1.0F : 0.0F);
  return cells;
}

}  // namespace

std::string steps_csv(const ExploreRun& run) {
  std::string text;
  for (const ExploreStep& step : run.steps) {
    const std::vector<Field> fields = fields_of(step);
    if (text.empty()) {
      for (const auto& [name, value] : fields) {
        if (!text.empty()) text += ',';
        text += name;
      }
      text += '\n';
    }
    for (std::size_t i = 0; i < fields.size(); ++i) {
      if (i > 0) text += ',';
      text += number(fields[i].second);
    }
    text += '\n';
  }
  return text;
}

std::string steps_jsonl(const ExploreRun& run) {
  std::string text;
  for (const ExploreStep& step : run.steps) {
    nlohmann::ordered_json line;
    for (const auto& [name, value] : fields_of(step)) {
      if (name == "step")
        line[name] = step.step;
      else
        line[name] = std::isnan(value) ? nlohmann::ordered_json() : nlohmann::ordered_json::parse(number(value));
    }
    text += line.dump() + '\n';
  }
  return text;
}

std::string times_csv(const ExploreRun& run) {
  std::string text = "step,simulate_s,filter_s,map_s,plugin_s,plan_s\n";
  for (std::size_t i = 0; i < run.times.size(); ++i) {
    const ExploreTimes& t = run.times[i];
    text += fmt::format("{},{:.6f},{:.6f},{:.6f},{:.6f},{:.6f}\n", i, t.simulate_s, t.filter_s, t.map_s, t.guest_s,
                        t.plan_s);
  }
  return text;
}

nlohmann::json summary_of(const ExploreRun& run, const ExploreSite& site, const Vehicle& vehicle) {
  const ExploreStep& last = run.steps.back();
  double least_m = clearance_far_m;
  double drift_m = 0;
  int below = 0;
  for (const ExploreStep& s : run.steps) {
    least_m = std::min(least_m, s.clearance_m);
    below += s.clearance_m < vehicle.radius_m ? 1 : 0;
    drift_m = std::max(drift_m, (s.T_world_sonar.translation() - s.T_world_sonar_est.translation()).norm());
  }
  nlohmann::json reached;
  for (const double goal : {0.5, 0.75, 0.9, 0.95, 0.99}) {
    const auto first = std::ranges::find_if(run.steps, [&](const ExploreStep& s) { return s.scores.coverage >= goal; });
    reached[fmt::format("{}", goal)] = first == run.steps.end() ? nlohmann::json() : nlohmann::json(first->step);
  }
  const auto count = [](const ColumnMask& mask) { return std::ranges::count(mask, 1); };
  return {{"end", name_of(run.end)},
          {"steps", run.steps.size()},
          {"time_s", last.time_s},
          {"coverage", or_null(last.scores.coverage)},
          {"boundary_found", or_null(last.scores.boundary_found)},
          {"fpr", or_null(last.scores.fpr)},
          {"fnr", or_null(last.scores.fnr)},
          {"least_clearance_m", least_m},
          {"steps_below_radius", below},
          {"path_m", last.path_m},
          {"largest_drift_m", drift_m},
          {"coverage_reached_at_step", reached},
          {"reachable_free_columns", count(site.reachable.free)},
          {"boundary_columns", count(site.reachable.boundary)},
          {"known_free_m", site.known_free_m},
          {"resolution_m", site.map_frame.resolution_m},
          {"layers", site.map_frame.size[2]}};
}

void write_explored_map(const LogOddsGrid& grid, const std::filesystem::path& path) {
  write_map(dense_map(grid), path);
}

Slice read_guest_map(const std::filesystem::path& path, const Slice& like, const GridFrame& slab) {
  return columns_of(read_cells(path), like, slab);
}

Slice columns_of(const LogOddsMap& map, const Slice& like, const GridFrame& slab) {
  const GridFrame& frame = map.frame;
  const double low_m = slab.origin_m.z();
  const double high_m = low_m + slab.size[2] * slab.resolution_m;
  Slice slice{like.frame, std::vector<ColumnState>(like.columns.size(), ColumnState::unknown)};
  for (int iy = 0; iy < like.frame.size[1]; ++iy) {
    for (int ix = 0; ix < like.frame.size[0]; ++ix) {
      const Vec3 cell = (Vec3(like.x_m(ix), like.y_m(iy), low_m) - frame.origin_m) / frame.resolution_m;
      const int x = static_cast<int>(std::clamp(std::floor(cell.x()), -1.0, 1e9));
      const int y = static_cast<int>(std::clamp(std::floor(cell.y()), -1.0, 1e9));
      int cells = 0, free = 0, occupied = 0;
      for (int z = 0; z < frame.size[2]; ++z) {
        const double centre_m = frame.centre_m(0, 0, z).z();
        if (frame.size[2] > 1 && (centre_m < low_m || centre_m > high_m)) continue;
        if (!frame.contains(x, y, z)) continue;
        const float value = map.log_odds[frame.index(x, y, z)];
        ++cells, free += value < 0 ? 1 : 0, occupied += value > 0 ? 1 : 0;
      }
      ColumnState& state = slice.columns[slice.index(ix, iy)];
      if (cells > 0 && free == cells) state = ColumnState::free;
      if (occupied > 0) state = ColumnState::occupied;
    }
  }
  return slice;
}

}  // namespace ensonify
