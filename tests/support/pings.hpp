#pragma once

#include <algorithm>
#include <numeric>
#include <utility>
#include <vector>

#include "ensonify/scenes/scene.hpp"
#include "ensonify/sensor_models/sonar_model.hpp"
#include "ensonify/sim/trace_ping.hpp"

/// Instruments and scenes made in code, bare of all that a formula would have to carry along.
namespace ensonify::test {

struct SonarSpec {
  int beams = 129;
  double azimuth_fov_deg = 12.9;    ///< of the cells, outer border to outer border
  double elevation_fov_deg = 20.0;  ///< -3 dB, or all that there is where the shading is box
  double range_min_m = 0.5;
  double range_max_m = 10.0;
  int bins = 950;
  Shading elevation = Shading::box;
  int elevation_rays = 0;  ///< 0: as the product chooses
  int azimuth_rays = 0;
};

/// Equal beam cells, no fan pattern, and 1 Hz, where water absorbs nothing: only geometry and spreading are left.
inline SonarModel bare_sonar(const SonarSpec& spec = {}) {
  SonarModel sonar;
  sonar.name = "bare";
  sonar.geometry.range_min_m = spec.range_min_m;
  sonar.geometry.range_max_m = spec.range_max_m;
  sonar.geometry.range_bins = spec.bins;
  for (int b = 0; b < spec.beams; ++b) {
    sonar.geometry.beam_azimuth_rad.push_back(radians(spec.azimuth_fov_deg) * (0.5 - (b + 0.5) / spec.beams));
  }
  sonar.geometry.elevation_fov_rad = radians(spec.elevation_fov_deg);
  sonar.frequency_hz = 1.0;
  sonar.bandwidth_hz = 262e3;
  sonar.source_level_db = 220;
  sonar.receive_azimuth = Aperture(Shading::hann, radians(0.4));
  sonar.elevation = Aperture(spec.elevation, sonar.geometry.elevation_fov_rad);
  sonar.rays = {spec.azimuth_rays, spec.elevation_rays};
  return sonar;
}

inline constexpr double test_lambert_db = -10.0;
inline constexpr double test_mu = 0.1;  ///< 10^(test_lambert_db / 10)

/// One Lambert material, every mesh an instance in the world frame.
inline Scene scene_of(std::vector<TriangleMesh> meshes) {
  Scene scene;
  scene.name = "test";
  scene.materials.push_back({"lambert", test_lambert_db, -300.0, 50.0, "test"});
  for (std::size_t m = 0; m < meshes.size(); ++m) {
    Instance instance;
    instance.name = "object";
    instance.mesh = static_cast<int>(m);
    scene.instances.push_back(instance);
  }
  scene.meshes = std::move(meshes);
  return scene;
}

inline Ping ping_of(const Scene& scene, const SonarModel& sonar, const Pose& T_world_sonar = Pose::Identity(),
                    bool cell_truth = false) {
  const RayScene rays(scene);
  return PingTracer(rays, sonar, scene.water).trace(T_world_sonar, {.cell_truth = cell_truth});
}

inline double sum_of(const Image2<float>& image) {
  return std::accumulate(image.pixels().begin(), image.pixels().end(), 0.0);
}

/// Energy of one beam over all bins.
inline double beam_sum(const Image2<float>& image, int beam) {
  double sum = 0;
  for (int bin = 0; bin < image.rows(); ++bin) sum += static_cast<double>(image(bin, beam));
  return sum;
}

inline int peak_bin(const Image2<float>& image, int beam) {
  int best = 0;
  for (int bin = 1; bin < image.rows(); ++bin) best = image(bin, beam) > image(best, beam) ? bin : best;
  return best;
}

/// Bin and beam of the largest cell.
inline std::pair<int, int> peak_cell(const Image2<float>& image) {
  const auto at = std::max_element(image.pixels().begin(), image.pixels().end()) - image.pixels().begin();
  return {static_cast<int>(at / image.columns()), static_cast<int>(at % image.columns())};
}

/// Slope of the least-squares line through (x, y).
inline double slope_of(const std::vector<double>& x, const std::vector<double>& y) {
  const double n = static_cast<double>(x.size());
  const double mx = std::accumulate(x.begin(), x.end(), 0.0) / n;
  const double my = std::accumulate(y.begin(), y.end(), 0.0) / n;
  double xy = 0;
  double xx = 0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    xy += (x[i] - mx) * (y[i] - my);
    xx += (x[i] - mx) * (x[i] - mx);
  }
  return xy / xx;
}

/// Simpson's rule with an even number of steps.
template <typename F>
double integral(double low, double high, const F& f, int steps = 2000) {
  const double h = (high - low) / steps;
  double sum = f(low) + f(high);
  for (int i = 1; i < steps; ++i) sum += (i % 2 == 1 ? 4.0 : 2.0) * f(low + i * h);
  return sum * h / 3.0;
}

}  // namespace ensonify::test
