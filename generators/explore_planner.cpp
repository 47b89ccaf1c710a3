#include "ensonify/generators/explore_planner.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "ensonify/core/parallel.hpp"

namespace ensonify {
namespace {

constexpr int headings = 120;
constexpr int most_steps_to_goal = 200;
constexpr double worth_left_share = 0.4;  ///< of a goal's worth, below which another is looked for
constexpr double arrived_rad = radians(2);

double heading_rad(int i) { return turn_between(0.0, 2.0 * std::numbers::pi * (i + 0.5) / headings); }

void mark_disc(const Slice& slice, const PlanarPose& at, double radius_m, ColumnMask& mask) {
  const int reach = 1 + static_cast<int>(radius_m / slice.frame.resolution_m);
  const int x = slice.ix_of(at.x_m);
  const int y = slice.iy_of(at.y_m);
  for (int iy = y - reach; iy <= y + reach; ++iy) {
    for (int ix = x - reach; ix <= x + reach; ++ix) {
      const bool within = std::hypot(slice.x_m(ix) - at.x_m, slice.y_m(iy) - at.y_m) <= radius_m;
      if (within && slice.contains(ix, iy)) mask[slice.index(ix, iy)] = 1;
    }
  }
}

void mark_way(const Slice& slice, const PlanarPose& from, const PlanarPose& to, double radius_m,
              PlannerMemory& memory) {
  const double length = std::hypot(to.x_m - from.x_m, to.y_m - from.y_m);
  const int pieces = 1 + static_cast<int>(length / (0.5 * slice.frame.resolution_m));
  for (int i = 0; i <= pieces; ++i) {
    const double share = static_cast<double>(i) / pieces;
    const PlanarPose at{from.x_m + share * (to.x_m - from.x_m), from.y_m + share * (to.y_m - from.y_m), 0};
    mark_disc(slice, at, radius_m, memory.body);
    const int ix = slice.ix_of(at.x_m);
    const int iy = slice.iy_of(at.y_m);
    if (slice.contains(ix, iy)) memory.trail[slice.index(ix, iy)] = 1;
  }
}

struct Choice {
  double value = 0;  ///< m2 a second
  PlannerMemory::Goal goal;
};

/// The best heading at a place.
Choice best_there(const PlannerSettings& settings, const Slice& slice, const ColumnWorth& worth, const PlanarPose& at,
                  std::size_t column, double way_m) {
  const auto width = static_cast<std::size_t>(slice.frame.size[0]);
  PlanarPose place{slice.x_m(static_cast<int>(column % width)), slice.y_m(static_cast<int>(column / width)), 0};
  if (way_m == 0) place = at;
  const std::vector<double> worths =
      worth_by_heading(worth_by_bearing(slice, worth, settings.view, place.x_m, place.y_m, headings), settings.view);
  Choice best;
  for (int i = 0; i < headings; ++i) {
    const double m2 = worths[static_cast<std::size_t>(i)];
    if (m2 < settings.least_worth_m2) continue;
    place.yaw_rad = heading_rad(i);
    const double turn_s = std::abs(turn_between(at.yaw_rad, place.yaw_rad)) / settings.limits.turn_radps;
    const double value = m2 / (settings.pause_s + std::max(way_m / settings.limits.speed_mps, turn_s));
    if (value > best.value) best = {value, {place, column, m2, 0}};
  }
  return best;
}

std::optional<PlannerMemory::Goal> choose_goal(const PlannerSettings& settings, const Slice& slice,
                                               const ColumnWorth& worth, const Ways& ways, const PlanarPose& at,
                                               std::size_t here) {
  const int spacing = std::max(1, static_cast<int>(std::lround(settings.spacing_m / slice.frame.resolution_m)));
  std::vector<std::size_t> places{here};
  for (int iy = spacing / 2; iy < slice.frame.size[1]; iy += spacing) {
    for (int ix = spacing / 2; ix < slice.frame.size[0]; ix += spacing) {
      const std::size_t column = slice.index(ix, iy);
      if (ways.reaches(column) && column != here) places.push_back(column);
    }
  }
  std::vector<Choice> choices(places.size());
  parallel_for(static_cast<int>(places.size()), [&](int i) {
    const std::size_t column = places[static_cast<std::size_t>(i)];
    choices[static_cast<std::size_t>(i)] = best_there(settings, slice, worth, at, column, ways.length_m[column]);
  });
  const auto best = std::ranges::max_element(choices, {}, &Choice::value);
  return best->value > 0 ? std::optional(best->goal) : std::nullopt;
}

/// The view from there was taken, or could not be.
bool is_over(const Slice& slice, const PlanarPose& at, const PlannerMemory::Goal& goal) {
  const bool there = std::hypot(goal.pose.x_m - at.x_m, goal.pose.y_m - at.y_m) < 0.5 * slice.frame.resolution_m &&
                     std::abs(turn_between(at.yaw_rad, goal.pose.yaw_rad)) < arrived_rad;
  return there || goal.steps >= most_steps_to_goal;
}

bool still_good(const PlannerSettings& settings, const Slice& slice, const ColumnWorth& worth, const Ways& ways,
                const PlannerMemory::Goal& goal) {
  if (!ways.reaches(goal.column)) return false;
  const std::vector<double> bearings =
      worth_by_bearing(slice, worth, settings.view, goal.pose.x_m, goal.pose.y_m, headings);
  double now = 0;
  for (int i = 0; i < headings; ++i) {
    const double azimuth = turn_between(goal.pose.yaw_rad, heading_rad(i));
    if (azimuth >= settings.view.starboard_rad && azimuth <= settings.view.port_rad) {
      now += bearings[static_cast<std::size_t>(i)];
    }
  }
  return now >= std::max(settings.least_worth_m2, worth_left_share * goal.worth_m2);
}

}  // namespace

PlannerMemory memory_at(const Slice& slice, const PlanarPose& start, double known_free_m) {
  PlannerMemory memory;
  memory.looks = {std::vector<std::uint8_t>(slice.columns.size(), 0),
                  std::vector<float>(slice.columns.size(), std::numeric_limits<float>::infinity())};
  memory.body.assign(slice.columns.size(), 0);
  memory.trail.assign(slice.columns.size(), 0);
  mark_disc(slice, start, known_free_m, memory.body);
  return memory;
}

std::optional<PlanarPose> plan_step(const PlannerSettings& settings, const Slice& map, const PlanarPose& at,
                                    PlannerMemory& memory) {
  mark_way(map, memory.last.value_or(at), at, settings.radius_m, memory);
  memory.last = at;
  Slice slice = map;
  for (std::size_t i = 0; i < slice.columns.size(); ++i) {
    if (memory.body[i] != 0) slice.columns[i] = ColumnState::free;
  }
  count_looks(slice, settings.view, at, memory.looks);
  ColumnWorth worth = worth_of(slice, settings.interest, memory.looks, settings.resolved_m);
  if (memory.goal && is_over(slice, at, *memory.goal)) {
    count_in_vain(slice, worth, settings.view, memory.goal->pose, headings, memory.looks);
    worth = worth_of(slice, settings.interest, memory.looks, settings.resolved_m);
    memory.goal.reset();
  }

  ColumnMask allowed = columns_with_room(slice, settings.clearance_m);
  for (std::size_t i = 0; i < allowed.size(); ++i) {
    allowed[i] = (allowed[i] != 0 && settings.area[i] != 0) || memory.trail[i] != 0 ? 1 : 0;
  }
  const int ix = slice.ix_of(at.x_m);
  const int iy = slice.iy_of(at.y_m);
  if (!slice.contains(ix, iy)) return std::nullopt;
  const std::size_t here = slice.index(ix, iy);
  const Ways ways = shortest_ways(slice, allowed, ix, iy);
  if (!memory.goal || !still_good(settings, slice, worth, ways, *memory.goal)) {
    memory.goal = choose_goal(settings, slice, worth, ways, at, here);
  }
  if (!memory.goal) return std::nullopt;

  PlannerMemory::Goal& goal = *memory.goal;
  ++goal.steps;
  if (goal.column == here) return limited_step(at, goal.pose, settings.limits);
  PlanarPose wanted = carrot(slice, allowed, way_to(ways, goal.column), at, settings.look_ahead_m);
  const bool near = ways.length_m[goal.column] <= settings.turn_early_m;
  wanted.yaw_rad = near ? goal.pose.yaw_rad : std::atan2(wanted.y_m - at.y_m, wanted.x_m - at.x_m);
  return limited_step(at, wanted, settings.limits);
}

}  // namespace ensonify
