#include "ensonify/scenes/basic_shapes.hpp"
#include "ensonify/scenes/shape_request.hpp"

namespace ensonify {
namespace {

Assembly build_hull(const ShapeRequest& r) {
  const double length_m = r.length("length_m"), beam_m = r.length("beam_m");
  const double draft_m = r.length("draft_m"), freeboard_m = r.length_or("freeboard_m", 0.6);
  return assembly_of(make_hull(length_m, beam_m, draft_m, freeboard_m));
}

}  // namespace

ShapeTable vessel_shapes() { return {{"hull", build_hull}}; }

}  // namespace ensonify
