#include "ensonify/generators/describe.hpp"

#include <array>
#include <cmath>
#include <nlohmann/json.hpp>

namespace ensonify {

using nlohmann::json;

json describe(const Distribution& distribution) {
  struct {
    json operator()(const Constant& d) const { return d.value; }
    json operator()(const Uniform& d) const { return {{"uniform", {d.low, d.high}}}; }
    json operator()(const LogUniform& d) const { return {{"log_uniform", {d.low, d.high}}}; }
    json operator()(const Normal& d) const { return {{"normal", {d.mean, d.sigma}}}; }
    json operator()(const Choice& d) const { return {{"choice", d.values}}; }
  } visitor;
  return std::visit(visitor, distribution);
}

namespace {

/// In degrees, nine digits after the point: what was given with so many is written so, and read back to the same bits.
double rounded_deg(double angle_rad) { return std::round(degrees(angle_rad) * 1e9) / 1e9; }

/// The path under the key that the recipe has for it.
json describe_path(const PathSpec& path) {
  struct {
    json operator()(const SceneWaypoints&) const { return {{"path", "waypoints"}}; }
    json operator()(const OwnWaypoints& own) const {
      json list = json::array();
      for (const Pose& pose : own.T_world_sonar) {
        const Vec3 p = pose.translation();
        const auto [roll, pitch, yaw] = roll_pitch_yaw(pose);
        list.push_back({p.x(), p.y(), p.z(), rounded_deg(roll), rounded_deg(pitch), rounded_deg(yaw)});
      }
      return {{"waypoints", list}};
    }
    json operator()(const Lawnmower& mow) const {
      json entry{{"depth_m", mow.depth_m},
                 {"spacing_m", mow.spacing_m},
                 {"heading_deg", mow.heading_deg},
                 {"pitch_deg", mow.pitch_deg}};
      if (const auto& a = mow.area_m) entry["area"] = {a->min().x(), a->min().y(), a->max().x(), a->max().y()};
      return {{"lawnmower", entry}};
    }
    json operator()(const Orbit& orbit) const {
      json entry{{"radius_m", orbit.radius_m},
                 {"depth_m", orbit.depth_m},
                 {"clockwise", orbit.clockwise},
                 {"start_deg", orbit.start_deg}};
      if (const auto* object = std::get_if<std::string>(&orbit.about)) entry["object"] = *object;
      if (const auto* c = std::get_if<Vec3>(&orbit.about)) entry["center"] = {c->x(), c->y(), c->z()};
      if (orbit.pitch_deg) entry["pitch_deg"] = *orbit.pitch_deg;
      if (orbit.turns) entry["turns"] = *orbit.turns;
      return {{"orbit", entry}};
    }
    json operator()(const WallFollow& wall) const {
      constexpr std::array names{"all", "east", "north", "west", "south"};
      return {{"wall",
               {{"object", wall.object},
                {"standoff_m", wall.standoff_m},
                {"depth_m", wall.depth_m},
                {"pitch_deg", wall.pitch_deg},
                {"side", names[static_cast<std::size_t>(wall.side)]},
                {"clockwise", wall.clockwise}}}};
    }
    json operator()(const RecordedPath& recorded) const { return {{"file", recorded.file.string()}}; }
  } visitor;
  return std::visit(visitor, path);
}

json describe_trajectory(const TrajectoryPoses& trajectory) {
  json entry = describe_path(trajectory.path);
  entry["rate_hz"] = trajectory.rate_hz;
  entry["clearance_m"] = trajectory.clearance_m;
  if (trajectory.motion_during_ping) entry["motion_during_ping"] = true;
  if (!std::holds_alternative<RecordedPath>(trajectory.path)) {
    entry["speed_mps"] = describe(trajectory.speed_mps);
    entry["rounding_m"] = trajectory.rounding_m;
  }
  const AttitudeNoise& noise = trajectory.attitude_noise;
  entry["attitude_noise"] = {{"roll_deg", noise.roll_deg},
                             {"pitch_deg", noise.pitch_deg},
                             {"yaw_deg", noise.yaw_deg},
                             {"period_s", noise.period_s}};
  return entry;
}

}  // namespace

json describe(const Recipe& recipe) {
  const auto one_or_list = [](const std::vector<std::string>& words) {
    return words.size() == 1 ? json(words.front()) : json(words);
  };
  json sonar{{"model", recipe.sonar}, {"gain_db", describe(recipe.gain_db)}};
  if (recipe.range_min_m) sonar["range_min_m"] = *recipe.range_min_m;
  if (recipe.range_max_m) sonar["range_max_m"] = describe(*recipe.range_max_m);
  if (recipe.range_bins) sonar["range_bins"] = *recipe.range_bins == 0 ? json("native") : json(*recipe.range_bins);
  json result{{"name", recipe.name},
              {"title", recipe.title},
              {"seed", recipe.seed},
              {"sonar", sonar},
              {"noise", one_or_list(recipe.noise)},
              {"mask", {{"threshold", recipe.mask_threshold}}},
              {"truth", recipe.cell_truth}};
  result["drift"] = {{"radial_error_m", recipe.drift.radial_error_m}, {"after_s", recipe.drift.after_s}};
  for (const Split& split : recipe.splits) {
    json entry{{"frames", split.frames}};
    for (const PlaceRef& place : split.places) {
      entry["places"].push_back({{"name", place.name}, {"scene", place.scene}, {"layout", place.layout}});
    }
    if (const auto* random = std::get_if<RandomPoses>(&split.poses)) {
      entry["random_poses"] = {
          {"roll_deg", describe(random->roll_deg)},       {"pitch_deg", describe(random->pitch_deg)},
          {"yaw_deg", describe(random->yaw_deg)},         {"clearance_m", random->clearance_m},
          {"least_seen_share", random->least_seen_share}, {"tries", random->tries}};
    } else {
      entry["trajectory"] = describe_trajectory(std::get<TrajectoryPoses>(split.poses));
    }
    result["splits"][split.name] = entry;
  }
  return result;
}

json describe(const SonarModel& sonar) {
  const SonarGeometry& g = sonar.geometry;
  return {{"name", sonar.name},
          {"title", sonar.title},
          {"frequency_hz", sonar.frequency_hz},
          {"bandwidth_hz", sonar.bandwidth_hz},
          {"source_level_db", sonar.source_level_db},
          {"range_min_m", g.range_min_m},
          {"range_max_m", g.range_max_m},
          {"range_bins", g.range_bins},
          {"beam_azimuth_rad", g.beam_azimuth_rad},
          {"azimuth_width_rad", sonar.receive_azimuth.width_rad()},
          {"elevation_fov_rad", g.elevation_fov_rad},
          {"fan_edge_db", sonar.fan_edge_db},
          {"receive",
           {{"tvg_spreading_db", sonar.receive.tvg_spreading_db},
            {"tvg_absorption_db_per_m", sonar.receive.tvg_absorption_db_per_m},
            {"saturation_level_db", sonar.receive.saturation_level_db},
            {"gamma", sonar.receive.gamma},
            {"bits", sonar.receive.bits}}},
          {"rays", {{"azimuth_per_beam", sonar.rays.azimuth_rays_per_beam}, {"elevation", sonar.rays.elevation_rays}}},
          {"unverified", sonar.unverified}};
}

json describe(const std::vector<NoiseProfile>& noise) {
  if (noise.size() == 1) return describe(noise.front());
  json list = json::array();
  for (const NoiseProfile& profile : noise) list.push_back(describe(profile));
  return list;
}

json describe(const NoiseProfile& noise) {
  json stages = json::array();
  for (const auto& stage : noise.stages) {
    json entry;
    std::visit(
        [&](const auto& s) {
          entry["stage"] = s.kind;
          for (const auto& p : s.parameters()) entry[p.name] = describe(s.*p.member);
        },
        stage);
    stages.push_back(entry);
  }
  return {{"name", noise.name}, {"stages", stages}};
}

json describe(const Pose& T_a_b) {
  json rows = json::array();
  for (int r = 0; r < 4; ++r) {
    json row = json::array();
    for (int c = 0; c < 4; ++c) row.push_back(T_a_b.matrix()(r, c));
    rows.push_back(row);
  }
  return rows;
}

}  // namespace ensonify
