#include <fmt/format.h>

#include <algorithm>

#include "ensonify/scenes/catenary.hpp"
#include "ensonify/scenes/chain.hpp"
#include "ensonify/scenes/pipe.hpp"
#include "ensonify/scenes/shape_request.hpp"
#include "ensonify/scenes/tube.hpp"

namespace ensonify {
namespace {

constexpr int max_links = 20000;

/// `start`, `end` and `sag_m`, or `length_m` along +x from the origin.
HangingLine read_line(const ShapeRequest& r) {
  Reader& reader = r.field.reader;
  if (reader.has("length_m")) {
    if (reader.has("start")) reader.fail("start", "give either length_m or start and end");
    return {Vec3::Zero(), Vec3(r.length("length_m"), 0, 0), 0};
  }
  const Vec3 start = reader.vec3("start"), end = reader.vec3("end");
  const double sag_m = r.field.number_or("sag_m", 0, {0, length_limits_m.high});
  if ((end - start).norm() < length_limits_m.low) reader.fail("end", "must lie apart from start");
  if (sag_m > 20 * (end - start).head<2>().norm()) {
    reader.fail("sag_m", "must be at most 20 times the horizontal distance of start and end");
  }
  return {start, end, sag_m};
}

std::vector<Vec3> read_pipe_path(const ShapeRequest& r, double radius_m) {
  Reader& reader = r.field.reader;
  if (!reader.has("points")) return {Vec3::Zero(), Vec3(r.length("length_m"), 0, 0)};
  if (reader.has("length_m")) reader.fail("length_m", "give either length_m or points");
  const double bend_m = r.field.number_or("bend_radius_m", 3 * radius_m, {1.05 * radius_m, length_limits_m.high});
  std::vector<Vec3> points;
  for (const auto& p : read_points(reader, "points", 3, 2, 500, "[x, y, z]")) points.emplace_back(p[0], p[1], p[2]);
  for (std::size_t i = 0; i + 1 < points.size(); ++i) {
    if ((points[i + 1] - points[i]).norm() < length_limits_m.low) {
      reader.fail("points", fmt::format("points {} and {} coincide", i, i + 1));
    }
  }
  std::size_t too_tight = 0;
  std::vector<Vec3> path_m = round_corners(points, bend_m, too_tight);
  if (too_tight > 0) {
    reader.fail("points", fmt::format("no room at point {} for a bend of {:.3g} m; move the points apart or lower "
                                      "bend_radius_m",
                                      too_tight, bend_m));
  }
  return path_m;
}

Assembly read_pipe(const ShapeRequest& r) {
  Reader& reader = r.field.reader;
  Pipe pipe;
  pipe.radius_m = r.length("radius_m");
  pipe.wall_m = r.field.number_or("wall_m", 0, {0, 0.99 * pipe.radius_m});
  pipe.segments = r.field.count_or("segments", 32, 3, 256);
  pipe.path_m = read_pipe_path(r, pipe.radius_m);
  pipe.flange_spacing_m = r.field.number_or("flange_spacing_m", 0, {0, length_limits_m.high});
  pipe.flange_radius_m = r.length_or("flange_radius_m", 1.5 * pipe.radius_m);
  pipe.flange_thickness_m = r.length_or("flange_thickness_m", 0.25 * pipe.radius_m);
  pipe.bolts = r.field.count_or("bolts", 0, 0, 64);
  if (pipe.flange_radius_m <= pipe.radius_m) reader.fail("flange_radius_m", "must be above radius_m");
  r.check_triangles("segments",
                    (pipe.wall_m > 0 ? 4.0 : 2.0) * static_cast<double>(pipe.path_m.size()) * pipe.segments);
  const double length_m = path_length_m(pipe.path_m);
  if (pipe.flange_spacing_m > 0) {
    if (pipe.flange_thickness_m > 0.5 * length_m) reader.fail("flange_thickness_m", "must be at most half the length");
    if (length_m / pipe.flange_spacing_m > 1000) reader.fail("flange_spacing_m", "gives more than 1000 flanges");
  }
  return build_pipe(pipe);
}

Assembly read_cable(const ShapeRequest& r) {
  const double radius_m = r.length("radius_m");
  const HangingLine line = read_line(r);
  const int pieces = r.field.count_or("pieces", 64, 1, 10000), segments = r.field.count_or("segments", 16, 3, 256);
  r.check_triangles("pieces", 2.0 * (pieces + 1) * segments);
  return assembly_of(make_bar(line.points_m(pieces), radius_m, segments));
}

Assembly read_chain(const ShapeRequest& r) {
  Reader& reader = r.field.reader;
  ChainLink link;
  link.length_m = r.length("link_length_m");
  link.wire_radius_m = r.length_or("wire_radius_m", link.length_m / 12);
  link.width_m = r.length_or("link_width_m", 7.2 * link.wire_radius_m);
  if (link.wire_radius_m > 0.12 * link.length_m) {
    reader.fail("wire_radius_m", "must be at most 0.12 of link_length_m, or the next link finds no room");
  }
  if (link.width_m < 6 * link.wire_radius_m || link.width_m > link.length_m) {
    reader.fail("link_width_m", "must lie between 6 wire_radius_m and link_length_m");
  }
  const HangingLine line = read_line(r);
  if (chain_links(link, line) > max_links) {
    reader.fail("link_length_m", fmt::format("gives more than {} links", max_links));
  }
  return build_chain(link, line);
}

}  // namespace

ShapeTable line_shapes() { return {{"pipe", read_pipe}, {"cable", read_cable}, {"chain", read_chain}}; }

}  // namespace ensonify
