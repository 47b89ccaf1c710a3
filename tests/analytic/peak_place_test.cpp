// Where echoes land. Everything is placed by p = r (cos phi cos theta, cos phi sin theta, sin phi) in the sonar frame,
// so the bin is floor((r - r0) / dr) and the beam is the one whose cell holds theta.
#include <gtest/gtest.h>

#include <cmath>
#include <ostream>

#include "support/meshes.hpp"
#include "support/pings.hpp"

namespace ensonify {
namespace {

using namespace test;

/// R = Rz(yaw) Ry(pitch) Rx(roll), written out (design: conventions).
Eigen::Matrix3d rotation(double roll, double pitch, double yaw) {
  const double cr = std::cos(roll), sr = std::sin(roll), cp = std::cos(pitch), sp = std::sin(pitch);
  const double cy = std::cos(yaw), sy = std::sin(yaw);
  Eigen::Matrix3d r;
  r << cy * cp, cy * sp * sr - sy * cr, cy * sp * cr + sy * sr,  //
      sy * cp, sy * sp * sr + cy * cr, sy * sp * cr - cy * sr,   //
      -sp, cp * sr, cp * cr;
  return r;
}

struct PlaceCase {
  double roll_deg, pitch_deg, yaw_deg;
};

void PrintTo(const PlaceCase& c, std::ostream* out) {
  *out << "roll " << c.roll_deg << " pitch " << c.pitch_deg << " yaw " << c.yaw_deg;
}

class PeakPlace : public testing::TestWithParam<PlaceCase> {
 protected:
  const Vec3 position{3.0, -2.0, -4.0};
  const Eigen::Matrix3d R =
      rotation(radians(GetParam().roll_deg), radians(GetParam().pitch_deg), radians(GetParam().yaw_deg));
  Pose pose() const {
    return pose_from_xyz_rpy(position, radians(GetParam().roll_deg), radians(GetParam().pitch_deg),
                             radians(GetParam().yaw_deg));
  }
};

// Sphere of radius a: the surface at depth x behind its front has area 2 pi a dx whatever x (Archimedes) and
// cos^2 i = (1 - x / a)^2, so a share 1 - (1 - u)^3 of the echo lies within u a of the front. With a = two bins and the
// front a tenth into its bin, u = 0.45 and the bin of the front holds 83 %. Across beams the chord is longest, and the
// incidence least, in the beam through the centre.
TEST_P(PeakPlace, SphereFrontAndBearing) {
  SonarSpec spec{.beams = 301, .azimuth_fov_deg = 60.2, .elevation_rays = 512, .azimuth_rays = 2};
  const SonarModel sonar = bare_sonar(spec);
  const double dr = sonar.geometry.bin_size_m();
  const double a = 2.0 * dr;
  for (const int bin : {60, 350}) {
    for (const int beam : {10, 75, 150, 201, 292}) {
      for (const double elevation_deg : {-6.0, 0.0, 4.0}) {
        const double r = sonar.geometry.range_min_m + (bin + 0.1) * dr + a;
        const double theta = radians(0.2 * (150 - beam));
        const double phi = radians(elevation_deg);
        const Vec3 centre(r * std::cos(phi) * std::cos(theta), r * std::cos(phi) * std::sin(theta), r * std::sin(phi));
        const Scene scene = scene_of({moved(sphere_mesh(a, 64, 32), position + R * centre)});
        EXPECT_EQ(peak_cell(ping_of(scene, sonar, pose()).echo.direct), std::pair(bin, beam))
            << "range " << r << " azimuth " << degrees(theta) << " elevation " << elevation_deg;
      }
    }
  }
}

// Plane at distance D, unit normal n in the sonar frame: r(theta, phi) = D / (n . d). For one theta the nearest point
// is at phi* = atan2(n_z, n_h), n_h = n_x cos theta + n_y sin theta, with r* = D / sqrt(n_h^2 + n_z^2). Near it
// r - r* = r* (phi - phi*)^2 / 2, so the energy up to a depth x behind r* grows as sqrt(x): of a bin that r* enters at
// a fraction f, the first bin holds sqrt(1 - f) and the next sqrt(2 - f) - sqrt(1 - f). The first is the larger where
// f < 2/3. (Left out: f within 0.1 of 2/3, and of 0 and 1 for the width of the beam.)
TEST_P(PeakPlace, WallNearestPointOfEveryBeam) {
  SonarSpec spec{.beams = 501, .azimuth_fov_deg = 10.02, .elevation_fov_deg = 24.0, .elevation_rays = 1024};
  const SonarModel sonar = bare_sonar(spec);
  const double dr = sonar.geometry.bin_size_m();
  int checked = 0;
  for (const double distance : {1.203, 2.517, 5.011, 8.008}) {
    for (const double bearing_deg : {-20.0, 0.0, 3.0, 15.0}) {
      const Vec3 n(std::cos(radians(bearing_deg)), std::sin(radians(bearing_deg)), 0.05);
      const Vec3 unit = n.normalized();
      const Vec3 n_world = R * unit;
      const Ping ping = ping_of(scene_of({wall_mesh(position + distance * n_world, n_world)}), sonar, pose());
      for (int beam = 0; beam < spec.beams; beam += 25) {
        const double theta = radians(0.02 * (250 - beam));
        const double n_h = unit.x() * std::cos(theta) + unit.y() * std::sin(theta);
        const double nearest = distance / std::hypot(n_h, unit.z());
        const double place = (nearest - sonar.geometry.range_min_m) / dr;
        const double f = place - std::floor(place);
        const double smear = nearest * std::tan(std::abs(theta - radians(bearing_deg))) * radians(0.02) / dr;
        if (std::abs(f - 2.0 / 3.0) < 0.1 + smear || f < smear || f > 1.0 - smear) continue;
        const int expected = static_cast<int>(place) + (f > 2.0 / 3.0 ? 1 : 0);
        EXPECT_EQ(peak_bin(ping.echo.direct, beam), expected)
            << "distance " << distance << " bearing " << bearing_deg << " beam " << beam << " fraction " << f;
        ++checked;
      }
    }
  }
  EXPECT_GT(checked, 100);
}

// A box whose front face looks at the sonar: nearest at distance D on the bearing of its normal, and lit in the first
// bins over the beams with |theta| < atan(w / 2 / D), its side edges.
TEST_P(PeakPlace, BoxFaceAndEdges) {
  SonarSpec spec{.beams = 301, .azimuth_fov_deg = 30.1, .elevation_rays = 512};
  const SonarModel sonar = bare_sonar(spec);
  const double dr = sonar.geometry.bin_size_m();
  for (const int bin : {100, 400, 800}) {
    const double front = sonar.geometry.range_min_m + (bin + 0.25) * dr;
    const double half_width = 0.15;
    TriangleMesh box = box_mesh({static_cast<float>(front), static_cast<float>(-half_width), -0.1F},
                                {static_cast<float>(front + 0.4), static_cast<float>(half_width), 0.1F});
    for (Eigen::Vector3f& v : box.vertices_m) v = (position + R * v.cast<double>()).cast<float>();
    const Ping ping = ping_of(scene_of({box}), sonar, pose());
    const double edge_deg = degrees(std::atan(half_width / front));
    int port = -1;
    int starboard = -1;
    for (int beam = 0; beam < spec.beams; ++beam) {
      if (beam_sum(ping.echo.direct, beam) <= 0.0) continue;
      port = port < 0 ? beam : port;
      starboard = beam;
    }
    EXPECT_EQ(peak_bin(ping.echo.direct, 150), bin);
    EXPECT_NEAR(0.1 * (150 - port), edge_deg, 0.1 + 1e-9);
    EXPECT_NEAR(0.1 * (starboard - 150), edge_deg, 0.1 + 1e-9);
  }
}

INSTANTIATE_TEST_SUITE_P(Attitudes, PeakPlace,
                         testing::Values(PlaceCase{0, 0, 0}, PlaceCase{0, 0, 130}, PlaceCase{25, 0, 40},
                                         PlaceCase{0, 35, -70}, PlaceCase{-20, 15, 170}));

}  // namespace
}  // namespace ensonify
