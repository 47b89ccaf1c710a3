// Worlds whose images and maps are known in closed form: a wall, a corner, a sphere, a tank from four poses.
#include <gtest/gtest.h>

#include "ensonify/mapping/integrate_ping.hpp"
#include "mapping/synthetic.hpp"

namespace ensonify {
namespace {

using namespace test;

constexpr double nothing = std::numeric_limits<double>::infinity();
constexpr double threshold = 30;

/// Range to the plane x = `x_m`.
auto wall_at(double x_m) {
  return [x_m](const Vec3& o, const Vec3& d) { return d.x() > 0 ? (x_m - o.x()) / d.x() : nothing; };
}

LogOddsGrid map_of(const std::vector<PosedImage>& pings, const InverseModel& model, const GridFrame& frame) {
  LogOddsGrid grid(frame);
  for (const PosedImage& ping : pings) integrate_ping(ping, threshold, model, grid);
  return grid;
}

/// A wall at D, square to the sonar, fills on every arc of azimuth theta the ranges D / cos(theta) up to
/// D / (cos(theta) cos(phi_max)). Volumes by integration over r^2 cos(phi) dr dphi dtheta.
struct WallVolumes {
  double before_m3 = 0;
  double echo_m3 = 0;
  double frustum_m3 = 0;
};

WallVolumes wall_volumes(const SonarGeometry& g, double wall_m) {
  const double half = 0.5 * g.elevation_fov_rad;
  const double outer = g.beam_edges_rad().front();
  constexpr int steps = 2000;
  WallVolumes v;
  for (int i = 0; i < steps; ++i) {
    const double theta = outer * (2 * (i + 0.5) / steps - 1);
    const double area = 2 * std::sin(half) * 2 * outer / steps / 3;
    const double near = std::pow(wall_m / std::cos(theta), 3);
    v.before_m3 += area * (near - std::pow(g.range_min_m, 3));
    v.echo_m3 += area * near * (std::pow(std::cos(half), -3) - 1);
    v.frustum_m3 += area * (std::pow(g.range_max_m, 3) - std::pow(g.range_min_m, 3));
  }
  return v;
}

TEST(ClosedForm, WallInTheArcModels) {
  const double wall_m = 3.2;
  const SonarGeometry g = sonar(60, 24, 5, 500, 256);
  const GridFrame frame = box_frame({-0.2, -3, -1.2}, {5.2, 3, 1.2}, 0.04);
  const std::vector<PosedImage> pings = {image_of(g, Pose::Identity(), wall_at(wall_m), 801)};
  const WallVolumes v = wall_volumes(g, wall_m);
  const ArcShape bare = {.footprint_cells = 0, .elevation_share = 1};

  const LogOddsGrid arc = map_of(pings, Arc{.shape = bare}, frame);
  EXPECT_NEAR(volume_m3(arc, is_occupied) / v.echo_m3, 1, 0.12);  // whole bins echo
  EXPECT_NEAR((volume_m3(arc, is_free) + volume_m3(arc, is_occupied)) / v.frustum_m3, 1, 0.005);

  const LogOddsGrid shadow = map_of(pings, ArcShadow{.shape = bare}, frame);
  EXPECT_NEAR(volume_m3(shadow, is_free) / v.before_m3, 1, 0.01);
  EXPECT_TRUE(volume_m3(shadow, is_occupied) == volume_m3(arc, is_occupied));
  // Nothing is known of what lies behind the wall.
  for_each_cell(frame, [&](const Cell& c) {
    const Vec3 p = frame.centre_m(c[0], c[1], c[2]);
    if (p.x() > wall_m + 0.02) {
      ASSERT_GE(shadow.at(c), 0);
    }
  });
}

TEST(ClosedForm, WallInTheModelOfPoints) {
  const double wall_m = 3.2;
  const GridFrame frame = box_frame({-0.2, -3, -0.48}, {5.2, 3, 0.48}, 0.04);
  const std::vector<PosedImage> pings = {
      image_of(sonar(60, 1, 5, 1000, 512), pose_from_xyz_rpy({0, 0, 0.02}, 0, 0, 0), wall_at(wall_m + 0.02))};
  const LogOddsGrid grid = map_of(pings, Points{}, frame);
  std::size_t wall_cells = 0;
  for_each_cell(frame, [&](const Cell& c) {
    const Vec3 p = frame.centre_m(c[0], c[1], c[2]);
    if (grid.at(c) > 0) {
      ++wall_cells;
      ASSERT_NEAR(p.x(), wall_m + 0.02, 0.021) << "one cell thick";
      ASSERT_NEAR(p.z(), 0.02, 0.001) << "the cells of elevation 0";
    }
  });
  EXPECT_NEAR(static_cast<double>(wall_cells), 2 * (wall_m + 0.02) * std::tan(radians(30)) / 0.04, 3);
  // The model takes the shadow for free water: the cell behind the wall, straight ahead.
  EXPECT_LT(grid.at(frame.cell_of({wall_m + 0.3, 0.02, 0.02})), 0);
}

/// Two walls that meet: each beam ends at the nearer of both, and the shadow begins there.
TEST(ClosedForm, Corner) {
  const GridFrame frame = box_frame({-0.2, -0.2, -0.4}, {4, 4, 0.4}, 0.05);
  const auto corner = [](const Vec3& o, const Vec3& d) {
    return std::min(d.x() > 0 ? (2.025 - o.x()) / d.x() : nothing, d.y() > 0 ? (3.025 - o.y()) / d.y() : nothing);
  };
  const Pose pose = pose_from_xyz_rpy({0, 0, 0.025}, 0, 0, radians(50));
  const std::vector<PosedImage> pings = {image_of(sonar(76, 4, 5, 500, 400), pose, corner)};
  for (const InverseModel& model : {InverseModel(Points{}), InverseModel(ArcShadow{}), InverseModel(Carve{})}) {
    const LogOddsGrid grid = map_of(pings, model, frame);
    const int layer = frame.cell_of({0, 0, 0.025})[2];
    for (double y = 0.6; y < 2.95; y += 0.05) {
      EXPECT_GT(grid.at(frame.cell_of({2.025, y, 0.025})), 0) << kind_of(model) << y;
      EXPECT_LT(grid.at(frame.cell_of({1.875, 0.925 * y, 0.025})), 0) << kind_of(model) << y;
    }
    for (double x = 0.2; x < 2; x += 0.05)
      EXPECT_GT(grid.at(frame.cell_of({x, 3.025, 0.025})), 0) << kind_of(model) << x;
    if (std::holds_alternative<Points>(model)) continue;
    for_each_cell(frame, [&](const Cell& c) {
      const Vec3 p = frame.centre_m(c[0], c[1], c[2]);
      if (c[2] == layer && (p.x() > 2.1 || p.y() > 3.1)) {
        ASSERT_GE(grid.at(c), 0);
      }
    });
  }
}

/// A sphere of radius R: an arc through its centre echoes first at distance - R. From a ring of poses `carve` keeps
/// what every one of them heard; that holds the cells that echoes came from, and nothing beyond the sphere's arcs.
TEST(ClosedForm, SphereIsNotCarvedAway) {
  const double radius_m = 0.6;
  const double distance_m = 2.5;
  const auto sphere = [&](const Vec3& o, const Vec3& d) {
    const double b = o.dot(d);
    const double c = b * b - o.squaredNorm() + radius_m * radius_m;
    return c > 0 && b < 0 ? -b - std::sqrt(c) : nothing;
  };
  const GridFrame frame = box_frame({-3, -3, -1.2}, {3, 3, 1.2}, 0.05);
  std::vector<PosedImage> pings;
  std::vector<Vec3> hits;
  for (int i = 0; i < 12; ++i) {
    const double yaw = radians(30.0 * i);
    const Pose pose = pose_from_xyz_rpy({-distance_m * std::cos(yaw), -distance_m * std::sin(yaw), 0}, 0.5 * i, 0, yaw);
    pings.push_back(image_of(sonar(40, 20, 4, 400, 256), pose, sphere, 401));
    const SonarGeometry& g = pings.back().geometry;
    for (const double azimuth : g.beam_azimuth_rad) {
      for (int e = -9; e <= 9; e += 3) {
        const Vec3 ray = pose.linear() * from_spherical({1, azimuth, radians(e)});
        const double r = sphere(pose.translation(), ray);
        if (r < nothing) hits.push_back(pose.translation() + r * ray);
      }
    }
  }
  const LogOddsGrid carved = map_of(pings, Carve{}, frame);
  const LogOddsGrid arcs = map_of(pings, ArcShadow{}, frame);
  std::size_t freed = 0;
  for (const Vec3& p : hits) freed += carved.at(frame.cell_of(p)) < 0;
  // At the limb another view may pass through the rest of a cell: less than a hundredth.
  EXPECT_LT(freed, hits.size() / 100) << "of " << hits.size();
  for_each_cell(frame, [&](const Cell& c) {
    const double r = frame.centre_m(c[0], c[1], c[2]).norm();
    if (r < radius_m - 0.1) {
      ASSERT_GE(carved.at(c), 0) << r;
    }
    if (carved.at(c) < 0) {
      ASSERT_NE(arcs.at(c), 0);
    }
  });
  // What is left is the sphere, and arcs where no other view contradicts.
  EXPECT_LT(volume_m3(carved, is_occupied), 0.8 * volume_m3(arcs, is_occupied));
  // Straight ahead the first echo is at distance - R, free before.
  EXPECT_GT(carved.at(frame.cell_of({-radius_m + 0.01, 0, 0.02})), 0);
  EXPECT_LT(carved.at(frame.cell_of({-radius_m - 0.12, 0, 0.02})), 0);
}

/// A tank of 6 x 4 x 3 m, a ping from near each corner across: what is free lies inside, the walls in view are found.
TEST(ClosedForm, TankFromFourPoses) {
  const Vec3 half(3, 2, 1.5);
  const auto tank = [&](const Vec3& o, const Vec3& d) {
    double r = nothing;
    for (int a = 0; a < 3; ++a) {
      if (d[a] != 0) r = std::min(r, (std::copysign(half[a], d[a]) - o[a]) / d[a]);
    }
    return r;
  };
  const GridFrame frame = box_frame({-4, -3, -2.5}, {4, 3, 2.5}, 0.1);
  std::vector<PosedImage> pings;
  for (int i = 0; i < 4; ++i) {
    const double x = i == 0 || i == 3 ? -2.4 : 2.4;
    const double y = i < 2 ? -1.4 : 1.4;
    pings.push_back(
        image_of(sonar(120, 20, 8, 512, 256), pose_from_xyz_rpy({x, y, 0.05}, 0, 0, std::atan2(-y, -x)), tank, 401));
  }
  const auto inside = [&](const Vec3& p, double margin) { return ((p.cwiseAbs() - half).array() < margin).all(); };
  for (const char* kind : {"arc_shadow", "carve", "oracle"}) {
    const LogOddsGrid grid = map_of(pings, inverse_model_named(kind), frame);
    std::size_t middle_free = 0;
    std::size_t middle = 0;
    for_each_cell(frame, [&](const Cell& c) {
      const Vec3 p = frame.centre_m(c[0], c[1], c[2]);
      if (!inside(p, 0.06)) {
        ASSERT_GE(grid.at(c), 0) << kind << " frees " << p.transpose();
      }
      if (std::abs(p.z() - 0.05) < 0.01 && inside(p, -0.15)) {
        ++middle;
        middle_free += grid.at(c) < 0;
      }
    });
    EXPECT_GT(static_cast<double>(middle_free), 0.97 * static_cast<double>(middle)) << kind;
    std::size_t wall = 0;
    std::size_t found = 0;
    for (double x = -2.85; x < 2.9; x += 0.1) {
      for (const double y : {-2.05, 2.05}) {
        ++wall;
        const Cell c = frame.cell_of({x, y, 0.05});
        found += grid.at(c) > 0 || grid.at({c[0], c[1] + (y < 0 ? 1 : -1), c[2]}) > 0;
      }
    }
    EXPECT_GT(static_cast<double>(found), 0.95 * static_cast<double>(wall)) << kind;
  }
}

}  // namespace
}  // namespace ensonify
