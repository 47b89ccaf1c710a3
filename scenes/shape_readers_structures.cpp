#include "ensonify/scenes/pile_row.hpp"
#include "ensonify/scenes/shape_request.hpp"

namespace ensonify {
namespace {

Assembly read_pile_row(const ShapeRequest& r) {
  PileRow row;
  Reader& reader = r.field.reader;
  row.piles = r.field.count("piles", 1, 1000);
  row.spacing_m = r.length("spacing_m");
  row.length_m = r.length("length_m");
  row.radius_m = read_distribution(reader, "radius_m", length_limits_m);
  row.tilt_deg = read_distribution_or(reader, "tilt_deg", 0, {-45, 45});
  row.offset_m = read_distribution_or(reader, "offset_m", 0, {-100, 100});
  return build_pile_row(row, r.key);
}

}  // namespace

ShapeTable structure_shapes() { return {{"pile_row", read_pile_row}}; }

}  // namespace ensonify
