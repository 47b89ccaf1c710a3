#include "ensonify/scenes/propeller.hpp"

#include <cmath>
#include <numbers>
#include <vector>

#include "ensonify/scenes/loft.hpp"

namespace ensonify {
namespace {

/// Elliptic sections from the hub to the tip, each turned by the angle of a screw of constant pitch.
TriangleMesh make_blade(double radius_m, double azimuth_rad) {
  constexpr int sections = 8, around = 10;
  const double pitch_m = 1.8 * radius_m;
  const Vec3 radial(0, std::cos(azimuth_rad), std::sin(azimuth_rad)), along = Vec3::UnitX();
  const Vec3 tangent = along.cross(radial);
  std::vector<Ring> rings;
  for (int i = 0; i <= sections; ++i) {
    const double share = 0.12 + 0.88 * i / sections;
    const double chord_m = radius_m * (0.2 + 0.45 * std::sin(std::numbers::pi * std::pow(share, 1.3)));
    const double thickness_m = radius_m * 0.08 * (1.15 - share);
    const double screw_rad = std::atan2(pitch_m, 2 * std::numbers::pi * share * radius_m);
    const Vec3 chordwise = std::cos(screw_rad) * tangent + std::sin(screw_rad) * along;
    const Vec3 across = radial.cross(chordwise);
    Ring ring;
    for (int k = 0; k < around; ++k) {
      const double angle = 2 * std::numbers::pi * k / around;
      ring.push_back(share * radius_m * radial + 0.5 * chord_m * std::cos(angle) * chordwise +
                     0.5 * thickness_m * std::sin(angle) * across);
    }
    rings.push_back(ring);
  }
  return loft(rings, fan_cap(around));
}

}  // namespace

TriangleMesh make_propeller(double radius_m, int blades) {
  const double hub_m = 0.2 * radius_m;
  TriangleMesh hub = turn_profile({{0.7 * hub_m, -1.4 * hub_m}, {hub_m, -0.5 * hub_m}, {hub_m, 1.2 * hub_m}}, 20);
  for (Eigen::Vector3f& v : hub.vertices_m) v = Eigen::Vector3f(v.z(), v.x(), v.y());
  std::vector<TriangleMesh> parts{hub};
  for (int i = 0; i < blades; ++i) parts.push_back(make_blade(radius_m, 2 * std::numbers::pi * (i + 0.25) / blades));
  return joined(parts);
}

}  // namespace ensonify
