#include "ensonify/scenes/trash_rack.hpp"

#include <algorithm>
#include <cmath>

#include "ensonify/scenes/basic_shapes.hpp"

namespace ensonify {

Assembly build_trash_rack(const TrashRack& rack) {
  Assembly result = {{make_box({1, 1, 1})}, {}};
  const auto add = [&](const Vec3& centre_m, const Vec3& size_m) {
    Eigen::Affine3d T = Eigen::Affine3d::Identity();
    T.translate(centre_m).scale(size_m);
    result.parts.push_back({0, T});
  };
  const double frame_depth_m = 1.6 * rack.bar_depth_m;
  for (const double side : {-0.5, 0.5}) {
    const double x = side * (rack.width_m - rack.frame_m);
    add({x, 0, 0.5 * rack.height_m}, {rack.frame_m, frame_depth_m, rack.height_m});
    const double z = 0.5 * rack.height_m + side * (rack.height_m - rack.frame_m);
    add({0, 0, z}, {rack.width_m, frame_depth_m, rack.frame_m});
  }
  const double clear_m = rack.width_m - 2 * rack.frame_m;
  const int bars = std::max(1, static_cast<int>(std::floor(clear_m / rack.bar_spacing_m)));
  for (int i = 0; i < bars; ++i) {
    const double x = (i - 0.5 * (bars - 1)) * rack.bar_spacing_m;
    add({x, 0, 0.5 * rack.height_m}, {rack.bar_width_m, rack.bar_depth_m, rack.height_m - rack.frame_m});
  }
  for (int i = 1; i <= rack.cross_bars; ++i) {
    const double z = rack.height_m * i / (rack.cross_bars + 1);
    add({0, 0.5 * rack.bar_depth_m, z}, {rack.width_m - rack.frame_m, 0.4 * rack.bar_depth_m, 0.6 * rack.bar_depth_m});
  }
  return result;
}

}  // namespace ensonify
