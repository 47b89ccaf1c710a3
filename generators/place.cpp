#include "ensonify/generators/place.hpp"

#include <algorithm>
#include <cmath>

#include "ensonify/sim/voxelize.hpp"

namespace ensonify {

Place make_place(const std::string& name, std::uint64_t layout, const std::string& isa) {
  Scene scene = load_scene(name, layout);
  RayScene rays(scene, isa);
  OccupancyGrid truth = voxelize(scene, scene.grid_resolution_m).grid;
  return {std::move(scene), std::move(rays), std::move(truth)};
}

bool has_room(const OccupancyGrid& truth, const Vec3& p_world, double radius_m) {
  const GridFrame& frame = truth.frame;
  const auto low = frame.cell_of(p_world - Vec3::Constant(radius_m));
  const auto high = frame.cell_of(p_world + Vec3::Constant(radius_m));
  if (!frame.contains(low[0], low[1], low[2]) || !frame.contains(high[0], high[1], high[2])) return false;
  constexpr double rounding_m = 1e-9;  // a point on the border of a cell touches it
  const Vec3 half = Vec3::Constant(0.5 * frame.resolution_m);
  for (int iz = low[2]; iz <= high[2]; ++iz) {
    for (int iy = low[1]; iy <= high[1]; ++iy) {
      for (int ix = low[0]; ix <= high[0]; ++ix) {
        if (truth.occupancy[frame.index(ix, iy, iz)] == static_cast<std::uint8_t>(Occupancy::free)) continue;
        const Vec3 beyond = ((p_world - frame.centre_m(ix, iy, iz)).cwiseAbs() - half).cwiseMax(0.0);
        if (beyond.norm() <= radius_m + rounding_m) return false;
      }
    }
  }
  return true;
}

}  // namespace ensonify
