#include "ensonify/scenes/pile_row.hpp"

#include <cmath>
#include <numbers>

#include "ensonify/scenes/basic_shapes.hpp"
#include "ensonify/scenes/loft.hpp"

namespace ensonify {
namespace {

/// As wide as deep, from -1 to 1, one long.
TriangleMesh make_h_beam() {
  constexpr double flange = 0.87, web = 0.08;  // inner face of the flange, half the web
  return extrude({{-1, -1},
                  {-flange, -1},
                  {-flange, -web},
                  {flange, -web},
                  {flange, -1},
                  {1, -1},
                  {1, 1},
                  {flange, 1},
                  {flange, web},
                  {-flange, web},
                  {-flange, 1},
                  {-1, 1}},
                 -0.5, 0.5);
}

}  // namespace

Assembly build_pile_row(const PileRow& row, RandomKey key) {
  Assembly result;
  result.meshes.push_back(row.h_beam ? make_h_beam() : make_cylinder(1.0, 1.0));
  for (int i = 0; i < row.piles; ++i) {
    RandomSequence random(key.child(static_cast<std::uint64_t>(i)));
    const double radius_m = sample(row.radius_m, random);
    const double tilt_rad = radians(sample(row.tilt_deg, random));
    const double azimuth_rad = random.uniform(0, 2 * std::numbers::pi);
    const Vec3 head(i * row.spacing_m + sample(row.offset_m, random), sample(row.offset_m, random), 0);

    const Vec3 tilt_axis(std::cos(azimuth_rad), std::sin(azimuth_rad), 0);
    Eigen::Affine3d T = Eigen::Affine3d::Identity();
    T.translate(head).rotate(Eigen::AngleAxisd(tilt_rad, tilt_axis));
    T.translate(Vec3(0, 0, -0.5 * row.length_m)).scale(Vec3(radius_m, radius_m, row.length_m));
    result.parts.push_back({0, T});
  }
  return result;
}

}  // namespace ensonify
