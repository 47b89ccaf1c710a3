#include "ensonify/sim/scene_view.hpp"

#include <embree3/rtcore.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include "ensonify/core/parallel.hpp"
#include "ensonify/core/random.hpp"
#include "ensonify/sim/flush_denormals.hpp"
#include "ensonify/sim/ray_scene.hpp"

namespace ensonify {
namespace {

using Eigen::Vector3f;

constexpr int samples_per_side = 3;  ///< of a pixel
constexpr int occlusion_rays = 6;    ///< of a sample
constexpr Rgb paper_colour{250, 250, 248};
constexpr float infinity = std::numeric_limits<float>::infinity();

struct Sample {
  float distance_m = infinity;
  int instance = -1;
  bool inside = false;  ///< the back of a face: the solid is cut open here
  Vector3f point_m = Vector3f::Zero();
  Vector3f normal = Vector3f::Zero();
};

struct Line {
  Vector3f origin_m, direction;
};

class Eye {
 public:
  Eye(const Camera& camera, int width, int height) : camera_(camera), width_(width), height_(height) {}

  /// Through (x, y) of the picture, pixels from the upper left corner.
  Line line(double x, double y) const {
    const double across = 0.5 - x / width_;
    const double up = (0.5 - y / height_) * height_ / width_;
    const Pose& T = camera_.T_world_camera;
    if (camera_.field_of_view_rad > 0) {
      const double spread = 2 * std::tan(0.5 * camera_.field_of_view_rad);
      const Vec3 direction = Vec3(1, across * spread, up * spread).normalized();
      return {T.translation().cast<float>(), (T.linear() * direction).cast<float>()};
    }
    return {(T * Vec3(0, across * camera_.width_m, up * camera_.width_m)).cast<float>(),
            T.linear().col(0).cast<float>()};
  }

 private:
  const Camera& camera_;
  double width_, height_;
};

/// Distances at which a line enters and leaves a box; enters later than it leaves where it misses.
std::pair<float, float> crossing_m(const Eigen::AlignedBox3f& box_m, const Line& line) {
  float enter = 0, leave = infinity;
  for (int axis = 0; axis < 3; ++axis) {
    const float a = (box_m.min()[axis] - line.origin_m[axis]) / line.direction[axis];
    const float b = (box_m.max()[axis] - line.origin_m[axis]) / line.direction[axis];
    enter = std::max(enter, std::min(a, b));
    leave = std::min(leave, std::max(a, b));
  }
  return {enter, leave};
}

RTCRayHit ray_hit(const Line& line, float near_m, float far_m) {
  RTCRayHit ray{};
  ray.ray = {line.origin_m.x(),
             line.origin_m.y(),
             line.origin_m.z(),
             near_m,
             line.direction.x(),
             line.direction.y(),
             line.direction.z(),
             0,
             far_m,
             ~0u,
             0,
             0};
  ray.hit.geomID = RTC_INVALID_GEOMETRY_ID;
  ray.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
  return ray;
}

Sample look(const RayScene& rays, const Line& line, float near_m) {
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  RTCRayHit ray = ray_hit(line, near_m, infinity);
  rtcIntersect1(rays.handle(), &context, &ray);
  Sample sample;
  if (ray.hit.geomID == RTC_INVALID_GEOMETRY_ID) return sample;
  const bool instanced = ray.hit.instID[0] != RTC_INVALID_GEOMETRY_ID;
  const RayScene::Surface& surface = rays.surfaces()[instanced ? ray.hit.instID[0] : ray.hit.geomID];
  Vector3f normal(ray.hit.Ng_x, ray.hit.Ng_y, ray.hit.Ng_z);
  if (instanced) normal = surface.normal_to_world * normal;
  normal.normalize();
  sample.distance_m = ray.ray.tfar;
  sample.instance = surface.instance;
  sample.inside = normal.dot(line.direction) > 0;
  sample.normal = sample.inside ? Vector3f(-normal) : normal;
  sample.point_m = line.origin_m + line.direction * ray.ray.tfar;
  return sample;
}

/// Share of a cosine-weighted hemisphere over the sample that meets nothing within reach_m.
float openness(const RayScene& rays, const Sample& sample, float reach_m, RandomSequence random) {
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  const Vector3f side = sample.normal.unitOrthogonal();
  const Vector3f other = sample.normal.cross(side);
  int open = 0;
  for (int i = 0; i < occlusion_rays; ++i) {
    const double azimuth = 2 * std::numbers::pi * (i + random.uniform(0, 1)) / occlusion_rays;
    const double sine2 = random.uniform(0, 1);
    const auto sine = static_cast<float>(std::sqrt(sine2)), cosine = static_cast<float>(std::sqrt(1 - sine2));
    const Vector3f direction = side * (sine * static_cast<float>(std::cos(azimuth))) +
                               other * (sine * static_cast<float>(std::sin(azimuth))) + sample.normal * cosine;
    RTCRayHit ray = ray_hit({sample.point_m + sample.normal * (1e-3f * reach_m), direction}, 0, reach_m);
    rtcOccluded1(rays.handle(), &context, &ray.ray);
    if (ray.ray.tfar >= 0) ++open;
  }
  return static_cast<float>(open) / occlusion_rays;
}

/// Light in linear terms; faces that show their back are cut faces and get a flat dark tone.
Vector3f shade(const Scene& scene, const Sample& sample, float open) {
  const Instance& instance = scene.instances[static_cast<std::size_t>(sample.instance)];
  const auto& colour = scene.materials[static_cast<std::size_t>(instance.material)].colour;
  const Vector3f albedo = Vector3f(colour[0], colour[1], colour[2]).array().pow(2.2f);
  if (sample.inside) return 0.12f * albedo;
  const Vector3f sun = Vector3f(-0.45f, 0.35f, 0.82f).normalized();
  const float sky = 0.5f + 0.5f * sample.normal.z();
  return albedo * (0.1f + 0.3f * open * sky + 0.25f * open + 0.35f * std::max(0.0f, sample.normal.dot(sun)));
}

/// An outline runs between two samples of different objects, or of one that folds over itself.
bool outlined(const Sample& a, const Sample& b, float scale_m) {
  if (a.instance != b.instance) return true;
  return a.instance >= 0 && std::abs(a.distance_m - b.distance_m) > 0.02f * scale_m && a.normal.dot(b.normal) < 0.9f;
}

Rgb displayed(const Vector3f& light) {
  const auto level = [](float v) {
    return static_cast<std::uint8_t>(std::lround(255.0f * std::pow(std::clamp(v, 0.0f, 1.0f), 1 / 2.2f)));
  };
  return {level(light.x()), level(light.y()), level(light.z())};
}

Scene without_surface(const Scene& scene) {
  Scene solid = scene;
  std::erase_if(solid.instances, [](const Instance& instance) { return !instance.obstacle; });
  return solid;
}

/// What there is to see within the bounds, seen from above; the water over it is not.
Eigen::AlignedBox3d visible_box(const Scene& scene) {
  Eigen::AlignedBox3d solid;
  for (const Instance& instance : scene.instances) {
    if (!instance.obstacle) continue;
    for (const Vector3f& v : scene.meshes[static_cast<std::size_t>(instance.mesh)].vertices_m) {
      solid.extend(instance.T_world_object * v.cast<double>());
    }
  }
  Eigen::AlignedBox3d window = scene.bounds_m;
  window.max().z() = std::max(window.max().z(), solid.max().z());
  const Eigen::AlignedBox3d both = window.intersection(solid);
  return both.isEmpty() ? scene.bounds_m : both;
}

}  // namespace

Camera plan_camera(const Scene& scene) {
  const Vec3 centre = scene.bounds_m.center();
  const Pose T = pose_from_xyz_rpy({centre.x(), centre.y(), 1e3}, 0, std::numbers::pi / 2, std::numbers::pi / 2);
  return {T, scene.bounds_m.sizes().x(), 0};
}

Camera side_camera(const Scene& scene) {
  const Vec3 centre = scene.bounds_m.center();
  const Pose T = pose_from_xyz_rpy({centre.x(), scene.navigable_m.min().y(), centre.z()}, 0, 0, std::numbers::pi / 2);
  return {T, scene.bounds_m.sizes().x(), 0};
}

Camera oblique_camera(const Scene& scene, double azimuth_rad, double elevation_rad, double aspect) {
  constexpr double field_of_view_rad = radians(32.0);
  const Eigen::AlignedBox3d box = visible_box(scene);
  const Pose look = pose_from_xyz_rpy(Vec3::Zero(), 0, elevation_rad, azimuth_rad + std::numbers::pi);
  const double half_x = std::tan(0.5 * field_of_view_rad), half_z = half_x / aspect;
  // The smallest distance from which all eight corners are within the picture.
  double distance_m = 0;
  for (int c = 0; c < 8; ++c) {
    const Vec3 corner = box.corner(static_cast<Eigen::AlignedBox3d::CornerType>(c)) - box.center();
    const Vec3 seen = look.linear().transpose() * corner;
    distance_m = std::max({distance_m, std::abs(seen.y()) / half_x - seen.x(), std::abs(seen.z()) / half_z - seen.x()});
  }
  Pose T = look;
  T.translation() = box.center() - look.linear().col(0) * (1.02 * distance_m);
  return {T, 0, field_of_view_rad};
}

Image2<Rgb> draw_scene(const Scene& scene, const Camera& camera, int width, int height) {
  constexpr int s = samples_per_side;
  const Scene solid = without_surface(scene);
  const RayScene rays(solid);
  const Eye eye(camera, s * width, s * height);
  Eigen::AlignedBox3f window_m = scene.bounds_m.cast<float>();
  const auto scale_m = static_cast<float>(scene.bounds_m.sizes().head<2>().minCoeff());
  // Walls often end at the bounds: a little wider, so that they are not cut in their own face.
  window_m.min().array() -= 1e-3f * scale_m;
  window_m.max().array() += 1e-3f * scale_m;
  window_m.max().z() += 2e3f;  // boats and piers rise out of the water
  const float reach_m = 0.12f * scale_m;

  Image2<Sample> samples(s * height, s * width);
  Image2<Rgb> picture(height, width);
  parallel_for(s * height, [&](int y) {
    const FlushDenormals flush;
    for (int x = 0; x < s * width; ++x) {
      const Line line = eye.line(x + 0.5, y + 0.5);
      const auto [enter, leave] = crossing_m(window_m, line);
      if (enter < leave) samples(y, x) = look(rays, line, enter);
    }
  });
  const RandomKey key = RandomKey::from_seed(0).child("ambient occlusion");
  parallel_for(height, [&](int row) {
    const FlushDenormals flush;
    for (int column = 0; column < width; ++column) {
      Vector3f light = Vector3f::Zero();
      for (int i = 0; i < s * s; ++i) {
        const int y = s * row + i / s, x = s * column + i % s;
        const Sample& sample = samples(y, x);
        Vector3f seen = Vector3f(paper_colour.red, paper_colour.green, paper_colour.blue) / 255.0f;
        seen = seen.array().pow(2.2f);
        if (sample.instance >= 0) {
          const auto address = static_cast<std::uint64_t>(y) * static_cast<std::uint64_t>(s * width) + x;
          seen = shade(solid, sample, openness(rays, sample, reach_m, RandomSequence(key.child(address))));
        }
        const bool edge = (x + 1 < s * width && outlined(sample, samples(y, x + 1), scale_m)) ||
                          (y + 1 < s * height && outlined(sample, samples(y + 1, x), scale_m));
        light += edge ? Vector3f(0.25f * seen) : seen;
      }
      picture(row, column) = displayed(light / (s * s));
    }
  });
  return picture;
}

}  // namespace ensonify
