#include "ensonify/scenes/access.hpp"

#include "ensonify/scenes/tube.hpp"

namespace ensonify {

TriangleMesh make_stairs(const Stairs& stairs) {
  Polygon outline{{0, 0}, {stairs.steps * stairs.run_m, 0}};  // x, z
  for (int step = stairs.steps; step > 0; --step) {
    outline.emplace_back(step * stairs.run_m, step * stairs.rise_m);
    outline.emplace_back((step - 1) * stairs.run_m, step * stairs.rise_m);
  }
  TriangleMesh mesh = extrude(outline, -0.5 * stairs.width_m, 0.5 * stairs.width_m);
  for (Eigen::Vector3f& v : mesh.vertices_m) v = Eigen::Vector3f(v.x(), -v.z(), v.y());
  return mesh;
}

Assembly build_ladder(const Ladder& ladder) {
  const Vec3 side(0, 0.5 * ladder.width_m, 0), up(0, 0, ladder.height_m);
  std::vector<Member> members{{side, side + up, ladder.stile_radius_m}, {-side, up - side, ladder.stile_radius_m}};
  for (double z = 0.5 * ladder.rung_spacing_m; z < ladder.height_m; z += ladder.rung_spacing_m) {
    members.push_back({side + Vec3(0, 0, z), Vec3(0, 0, z) - side, ladder.rung_radius_m});
  }
  return assembly_of_members(members, 16);
}

}  // namespace ensonify
