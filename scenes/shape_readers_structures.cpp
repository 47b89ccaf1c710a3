#include <fmt/format.h>

#include <algorithm>

#include "ensonify/scenes/access.hpp"
#include "ensonify/scenes/lattice.hpp"
#include "ensonify/scenes/pile_row.hpp"
#include "ensonify/scenes/shape_request.hpp"
#include "ensonify/scenes/sheet_piles.hpp"
#include "ensonify/scenes/trash_rack.hpp"
#include "ensonify/scenes/tyre.hpp"

namespace ensonify {
namespace {

constexpr int max_members = 5000;

/// Refuses what repeats too often, at the key that sets the spacing.
void check_count(const ShapeRequest& r, std::string_view spacing_key, double count, std::string_view what) {
  if (count > max_members) {
    r.field.reader.fail(spacing_key, fmt::format("gives {:.3g} {}, more than {}", count, what, max_members));
  }
}

Assembly read_pile_row(const ShapeRequest& r) {
  PileRow row;
  Reader& reader = r.field.reader;
  row.piles = r.field.count("piles", 1, 1000);
  row.spacing_m = r.length("spacing_m");
  row.length_m = r.length("length_m");
  row.radius_m = read_distribution(reader, "radius_m", length_limits_m);
  row.tilt_deg = read_distribution_or(reader, "tilt_deg", 0, {-45, 45});
  row.offset_m = read_distribution_or(reader, "offset_m", 0, {-100, 100});
  row.h_beam = r.choice_or_first("profile", {"tube", "h_beam"}) == "h_beam";
  return build_pile_row(row, r.key);
}

Assembly read_tyre(const ShapeRequest& r) {
  Tyre tyre;
  tyre.outer_radius_m = r.length_or("outer_radius_m", tyre.outer_radius_m);
  tyre.width_m = r.length_or("width_m", 0.56 * tyre.outer_radius_m);
  tyre.rim_radius_m = r.length_or("rim_radius_m", 0.56 * tyre.outer_radius_m);
  tyre.blocks = r.field.count_or("blocks", tyre.blocks, 0, 200);
  if (tyre.rim_radius_m >= 0.95 * tyre.outer_radius_m) {
    r.field.reader.fail("rim_radius_m", "must be below 0.95 of outer_radius_m");
  }
  return assembly_of(make_tyre(tyre));
}

Assembly read_sheet_pile_wall(const ShapeRequest& r) {
  Reader& reader = r.field.reader;
  SheetPileWall wall;
  wall.length_m = r.length("length_m");
  wall.height_m = r.length("height_m");
  wall.depth_m = r.length_or("depth_m", wall.depth_m);
  wall.pitch_m = r.length_or("pitch_m", wall.pitch_m);
  wall.thickness_m = r.length_or("thickness_m", wall.thickness_m);
  wall.z_profile = r.choice_or_first("profile", {"u", "z"}) == "z";
  wall.offset_m = read_distribution_or(reader, "offset_m", 0, {-1, 1});
  wall.cap_height_m = r.field.number_or("cap_height_m", 0, {0, 100});
  wall.cap_width_m = r.length_or("cap_width_m", 1.6 * wall.depth_m);
  if (wall.thickness_m > 0.1 * std::min(wall.depth_m, wall.pitch_m)) {
    reader.fail("thickness_m", "must be at most a tenth of depth_m and pitch_m");
  }
  if (wall.depth_m > 1.5 * wall.pitch_m) reader.fail("depth_m", "must be at most 1.5 pitch_m");
  check_count(r, "pitch_m", wall.length_m / wall.pitch_m, "piles");
  return build_sheet_pile_wall(wall, r.key);
}

Assembly read_truss(const ShapeRequest& r) {
  Truss truss;
  truss.length_m = r.length("length_m");
  truss.width_m = r.length("width_m");
  truss.height_m = r.length_or("height_m", truss.width_m);
  const double square_bays = std::clamp(std::round(truss.length_m / truss.width_m), 1.0, 500.0);
  truss.bays = r.field.count_or("bays", static_cast<int>(square_bays), 1, 500);
  truss.triangular = r.choice_or_first("section", {"box", "triangle"}) == "triangle";
  truss.chord_radius_m = r.length_or("chord_radius_m", truss.chord_radius_m);
  truss.brace_radius_m = r.length_or("brace_radius_m", 0.5 * truss.chord_radius_m);
  return assembly_of_members(truss_members(truss));
}

Assembly read_jacket(const ShapeRequest& r) {
  Jacket jacket;
  jacket.height_m = r.length("height_m");
  jacket.base_width_m = r.length("base_width_m");
  jacket.top_width_m = r.length_or("top_width_m", 0.5 * jacket.base_width_m);
  jacket.leg_radius_m = r.length_or("leg_radius_m", 0.02 * jacket.height_m);
  jacket.levels = r.field.count_or("levels", jacket.levels, 1, 50);
  jacket.k_braces = r.choice_or_first("braces", {"x", "k"}) == "k";
  jacket.brace_radius_m = r.length_or("brace_radius_m", 0.5 * jacket.leg_radius_m);
  jacket.pile_radius_m = r.field.number_or("pile_radius_m", 0, {0, 100});
  jacket.pile_length_m = r.length_or("pile_length_m", 0.12 * jacket.height_m);
  return assembly_of_members(jacket_members(jacket));
}

Assembly read_stairs(const ShapeRequest& r) {
  Stairs stairs;
  stairs.steps = r.field.count("steps", 1, 400);
  stairs.rise_m = r.length_or("rise_m", stairs.rise_m);
  stairs.run_m = r.length_or("run_m", stairs.run_m);
  stairs.width_m = r.length_or("width_m", stairs.width_m);
  return assembly_of(make_stairs(stairs));
}

Assembly read_ladder(const ShapeRequest& r) {
  Ladder ladder;
  ladder.height_m = r.length("height_m");
  ladder.width_m = r.length_or("width_m", ladder.width_m);
  ladder.rung_spacing_m = r.length_or("rung_spacing_m", ladder.rung_spacing_m);
  ladder.stile_radius_m = r.length_or("stile_radius_m", ladder.stile_radius_m);
  ladder.rung_radius_m = r.length_or("rung_radius_m", ladder.rung_radius_m);
  check_count(r, "rung_spacing_m", ladder.height_m / ladder.rung_spacing_m, "rungs");
  return build_ladder(ladder);
}

Assembly read_trash_rack(const ShapeRequest& r) {
  TrashRack rack;
  rack.width_m = r.length("width_m");
  rack.height_m = r.length("height_m");
  rack.bar_spacing_m = r.length_or("bar_spacing_m", rack.bar_spacing_m);
  rack.bar_width_m = r.length_or("bar_width_m", rack.bar_width_m);
  rack.bar_depth_m = r.length_or("bar_depth_m", rack.bar_depth_m);
  rack.frame_m = r.length_or("frame_m", rack.frame_m);
  rack.cross_bars = r.field.count_or("cross_bars", rack.cross_bars, 0, 100);
  if (rack.bar_width_m >= rack.bar_spacing_m) r.field.reader.fail("bar_width_m", "must be below bar_spacing_m");
  if (2 * rack.frame_m + rack.bar_spacing_m > std::min(rack.width_m, rack.height_m)) {
    r.field.reader.fail("frame_m", "leaves no room for a bar within width_m and height_m");
  }
  check_count(r, "bar_spacing_m", rack.width_m / rack.bar_spacing_m, "bars");
  return build_trash_rack(rack);
}

}  // namespace

ShapeTable structure_shapes() {
  return {{"pile_row", read_pile_row},
          {"tyre", read_tyre},
          {"sheet_pile_wall", read_sheet_pile_wall},
          {"truss", read_truss},
          {"jacket", read_jacket},
          {"stairs", read_stairs},
          {"ladder", read_ladder},
          {"trash_rack", read_trash_rack}};
}

}  // namespace ensonify
