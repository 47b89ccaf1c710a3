#include "ensonify/generators/explore_plugin.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "ensonify/core/error.hpp"
#include "ensonify/generators/describe.hpp"
#include "ensonify/generators/explore_files.hpp"
#include "ensonify/generators/json_text.hpp"
#include "ensonify/output/atomic_file.hpp"
#include "ensonify/output/png.hpp"

namespace ensonify {
namespace {

std::string one_line(const nlohmann::json& value) {
  return value.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

nlohmann::json hello(const ExploreSite& site, const Vehicle& vehicle, const SonarModel& sonar, int steps) {
  const SonarGeometry& g = sonar.geometry;
  const GridFrame& map = site.map_frame;
  nlohmann::json area;
  for (int iy = 0; iy < site.truth.frame.size[1]; ++iy) {
    for (int ix = 0; ix < site.truth.frame.size[0]; ++ix) {
      if (site.area[site.truth.index(ix, iy)] == 0) continue;
      if (area.is_null()) area["min"] = {site.truth.x_m(ix), site.truth.y_m(iy)};
      area["max"] = {site.truth.x_m(ix), site.truth.y_m(iy)};
    }
  }
  return {{"protocol", 1},
          {"steps", steps},
          {"sonar",
           {{"name", sonar.name},
            {"range_min_m", g.range_min_m},
            {"range_max_m", g.range_max_m},
            {"range_bins", g.range_bins},
            {"elevation_fov_rad", g.elevation_fov_rad},
            {"beam_azimuth_rad", g.beam_azimuth_rad}}},
          {"vehicle",
           {{"radius_m", vehicle.radius_m},
            {"height_m", vehicle.height_m},
            {"speed_mps", vehicle.limits.speed_mps},
            {"turn_rate_degps", degrees(vehicle.limits.turn_radps)},
            {"ping_rate_hz", vehicle.limits.ping_rate_hz}}},
          {"T_world_sonar_start", describe(site.start)},
          {"known_free_m", site.known_free_m},
          {"area", area},
          {"map",
           {{"origin_m", {map.origin_m.x(), map.origin_m.y(), map.origin_m.z()}},
            {"resolution_m", map.resolution_m},
            {"size", map.size}}}};
}

Image2<std::uint8_t> whole_levels(const Image2<float>& image) {
  Image2<std::uint8_t> whole(image.rows(), image.columns());
  std::ranges::transform(image.pixels(), whole.pixels().begin(),
                         [](float v) { return static_cast<std::uint8_t>(std::lround(std::clamp(v, 0.0F, 255.0F))); });
  return whole;
}

[[noreturn]] void refuse(int step, const std::string& what, const std::string& line) {
  constexpr std::size_t shown = 120;
  throw DataError(
      fmt::format("plug-in's answer to step {}: {}; it said: {}", step, what, one_line(line.substr(0, shown))));
}

PlanarPose pose_in(const nlohmann::json& value, int step, const std::string& line) {
  const auto sane = [](const nlohmann::json& v) { return v.is_number() && std::abs(v.get<double>()) <= 1e5; };
  if (!value.is_array() || value.size() != 6 || !std::ranges::all_of(value, sane)) {
    refuse(step, "pose must be six numbers, [x, y, z, roll, pitch, yaw], metres and degrees, none beyond 100000", line);
  }
  return {value[0].get<double>(), value[1].get<double>(), radians(value[5].get<double>())};
}

}  // namespace

GuestReply parse_reply(const std::string& line, int step, const Slice& like, const GridFrame& slab) {
  nlohmann::json answer;
  try {
    answer = parse_json(line, "answer");
  } catch (const DataError&) {
    refuse(step, "is no JSON", line);
  }
  constexpr auto* rule = "must be an object with one or more of pose, map and done, and nothing else";
  if (!answer.is_object() || answer.empty()) refuse(step, rule, line);
  GuestReply reply;
  for (const auto& [key, value] : answer.items()) {
    if (key == "pose") {
      reply.wanted = pose_in(value, step, line);
    } else if (key == "map") {
      if (!value.is_string()) refuse(step, "map must be the path of a .npz file", line);
      try {
        reply.map = read_guest_map(value.get<std::string>(), like, slab);
      } catch (const std::runtime_error& e) {
        refuse(step, e.what(), line);
      }
    } else if (key == "done") {
      if (!value.is_boolean()) refuse(step, "done must be true or false", line);
      reply.done = value.get<bool>();
    } else {
      refuse(step, fmt::format("\"{}\" is no key of an answer; it {}", key, rule), line);
    }
  }
  return reply;
}

ExplorePlugin::ExplorePlugin(PluginSettings settings, const ExploreSite& site, const Vehicle& vehicle,
                             const SonarModel& sonar, int steps)
    : settings_(std::move(settings)),
      like_{site.truth.frame, std::vector<ColumnState>(site.truth.columns.size(), ColumnState::unknown)},
      slab_(site.map_frame),
      process_(settings_.command, settings_.stop) {
  process_.say(one_line(hello(site, vehicle, sonar, steps)), settings_.timeout_s);
}

ExplorePlugin::~ExplorePlugin() {
  std::error_code no_throw;
  for (const char* name : {"raw.png", "filtered.png", "map.npz"}) {
    std::filesystem::remove(settings_.folder / name, no_throw);
  }
  std::filesystem::remove(settings_.folder, no_throw);  // stays where the plug-in has put files of its own into it
}

GuestReply ExplorePlugin::ask(const ExploreMoment& moment) {
  const std::filesystem::path folder = std::filesystem::absolute(settings_.folder);
  write_file(folder / "raw.png", encode_png(moment.ping.raw));
  write_file(folder / "filtered.png", encode_png(whole_levels(moment.ping.filtered)));
  write_explored_map(moment.grid, folder / "map.npz");
  process_.say(one_line({{"step", moment.step},
                         {"T_world_sonar_est", describe(moment.T_world_sonar_est)},
                         {"raw", (folder / "raw.png").string()},
                         {"filtered", (folder / "filtered.png").string()},
                         {"map", (folder / "map.npz").string()}}),
               settings_.timeout_s);
  return parse_reply(process_.hear(settings_.timeout_s), moment.step, like_, slab_);
}

}  // namespace ensonify
