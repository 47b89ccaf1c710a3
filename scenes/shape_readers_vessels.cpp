#include <algorithm>

#include "ensonify/scenes/basic_shapes.hpp"
#include "ensonify/scenes/shape_request.hpp"
#include "ensonify/scenes/ship.hpp"

namespace ensonify {
namespace {

Assembly build_hull(const ShapeRequest& r) {
  const double length_m = r.length("length_m"), beam_m = r.length("beam_m");
  const double draft_m = r.length("draft_m"), freeboard_m = r.length_or("freeboard_m", 0.6);
  return assembly_of(make_hull(length_m, beam_m, draft_m, freeboard_m));
}

Assembly read_ship(const ShapeRequest& r) {
  Reader& reader = r.field.reader;
  Ship ship;
  ship.length_m = r.field.number("length_m", {10, 1000});
  ship.beam_m = r.length_or("beam_m", 0.15 * ship.length_m);
  ship.depth_m = r.length_or("depth_m", 0.085 * ship.length_m);
  ship.draft_m = r.length_or("draft_m", 0.65 * ship.depth_m);
  ship.bilge_radius_m = r.length_or("bilge_radius_m", 0.2 * std::min(ship.beam_m, ship.depth_m));
  ship.bulb = reader.boolean_or("bulb", true);
  ship.hatches = r.field.count_or("hatches", 4, 0, 20);
  ship.masts = r.field.count_or("masts", 2, 0, 20);
  const std::string house = r.choice_or_first("house", {"aft", "middle", "none"});
  ship.house = house == "aft" ? Ship::House::aft : house == "middle" ? Ship::House::middle : Ship::House::none;
  ship.damage = r.field.number_or("damage", 0, unit_interval);
  if (ship.beam_m > 0.5 * ship.length_m) reader.fail("beam_m", "must be at most half of length_m");
  if (ship.depth_m > ship.beam_m) reader.fail("depth_m", "must be at most beam_m");
  if (ship.draft_m >= ship.depth_m) reader.fail("draft_m", "must be below depth_m");
  if (ship.bilge_radius_m > 0.4 * std::min(ship.beam_m, ship.depth_m)) {
    reader.fail("bilge_radius_m", "must be at most 0.4 of beam_m and of depth_m");
  }
  return build_ship(ship, r.key);
}

}  // namespace

ShapeTable vessel_shapes() { return {{"hull", build_hull}, {"ship", read_ship}}; }

}  // namespace ensonify
