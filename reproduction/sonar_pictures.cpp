#include "ensonify/reproduction/sonar_pictures.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "ensonify/generators/simulator.hpp"
#include "ensonify/output/fan_view.hpp"

namespace ensonify {
namespace {

constexpr double degree = std::numbers::pi / 180;

/// Over the corner of the quay: piles, wall and bed at once.
Pose where() {
  Pose T_world_sonar = Pose::Identity();
  T_world_sonar.translation() = Vec3(11.2, 4.8, -4.2);
  T_world_sonar.linear() =
      (Eigen::AngleAxisd(230 * degree, Vec3::UnitZ()) * Eigen::AngleAxisd(15 * degree, Vec3::UnitY()))
          .toRotationMatrix();
  return T_world_sonar;
}

Series arc(double range_m, double from_rad, double to_rad) {
  Series series{"", {}, {}};
  for (int i = 0; i <= 60; ++i) {
    const double angle = from_rad + (to_rad - from_rad) * i / 60;
    series.x.push_back(range_m * std::cos(angle));
    series.y.push_back(range_m * std::sin(angle));
  }
  return series;
}

/// From the sonar along one edge, over the far end, and back.
Series outline(const SonarGeometry& g, double from_rad, double to_rad) {
  Series series = arc(g.range_max_m, from_rad, to_rad);
  constexpr int points = 100;  // of an edge, so that a part of it can be shown
  for (std::vector<double>* values : {&series.x, &series.y}) {
    const std::vector<double> far = *values;
    values->clear();
    for (int i = 0; i < points; ++i) values->push_back(far.front() * i / points);
    values->insert(values->end(), far.begin(), far.end());
    for (int i = points; i-- > 0;) values->push_back(far.back() * i / points);
  }
  series.style = Series::Style::thin_line;
  return series;
}

/// x forward and y to port, drawn with port on the left: the plot's x is -y.
void turn(Series& series) {
  std::swap(series.x, series.y);
  for (double& x : series.x) x = -x;
}

Plot above(const PingTruth& truth, const SonarGeometry& g, double beam_rad) {
  Series met{"met by rays", {}, {}, Series::Style::points};
  for (int r = 0; r < truth.first_hit_range_m.rows(); r += 4) {
    const double elevation = static_cast<double>(truth.elevation_step_rad) * r;
    for (int c = 0; c < truth.first_hit_range_m.columns(); c += 8) {
      const double range = truth.first_hit_range_m(r, c);
      if (!(range < g.range_max_m)) continue;
      const auto column = static_cast<std::size_t>(c);
      const Vec3 p =
          from_spherical({range, truth.ray_azimuth_rad[column], truth.lowest_elevation_rad[column] + elevation});
      met.x.push_back(p.x());
      met.y.push_back(p.y());
    }
  }
  const double left = g.beam_edges_rad().front(), right = g.beam_edges_rad().back();
  Plot plot = titled_plot("", "to starboard [m]", "forward [m]");
  Series beam{
      "the beam of the side view", {0, g.range_max_m * std::cos(beam_rad)}, {0, g.range_max_m * std::sin(beam_rad)}};
  plot.series = {std::move(met), outline(g, left, right), std::move(beam)};
  for (Series& series : plot.series) turn(series);
  plot.series[1].name = "fan";
  plot.equal_scale = true;
  return plot;
}

Plot side(const PingTruth& truth, const SonarPictures& found) {
  const SonarGeometry& g = found.geometry;
  const double azimuth = g.beam_azimuth_rad[static_cast<std::size_t>(found.beam)];
  const auto nearest = std::ranges::min_element(truth.ray_azimuth_rad, {},
                                                [&](float a) { return std::abs(static_cast<double>(a) - azimuth); });
  const auto column = nearest - truth.ray_azimuth_rad.begin();
  Series met{"surfaces", {}, {}, Series::Style::points};
  for (int r = 0; r < truth.first_hit_range_m.rows(); ++r) {
    const double range = truth.first_hit_range_m(r, static_cast<int>(column));
    const double elevation = truth.lowest_elevation_rad[static_cast<std::size_t>(column)] +
                             static_cast<double>(truth.elevation_step_rad) * r;
    if (!(range < g.range_max_m)) continue;
    met.x.push_back(range * std::cos(elevation));
    met.y.push_back(range * std::sin(elevation));
  }
  const double half = g.elevation_fov_rad / 2;
  Plot plot = titled_plot("", "along the beam [m]", "up [m]");
  plot.series = {std::move(met), arc(found.range_m, -half, half), outline(g, -half, half)};
  plot.series[1].name = "one range, one pixel";
  plot.series[2].name = "nominal field of view";
  plot.x_range = {{found.range_m - 1.6, found.range_m + 0.6}};
  plot.y_range = {{-0.9, 0.7}};
  plot.equal_scale = true;
  return plot;
}

void find_pixel(const PingTruth& truth, const PingImages& images, SonarPictures& found) {
  const double half = found.geometry.elevation_fov_rad / 2;
  double widest = -1;
  for (int k = 0; k < truth.elevation_min_rad.rows(); ++k) {
    for (int b = 0; b < truth.elevation_min_rad.columns(); ++b) {
      const double low = truth.elevation_min_rad(k, b), high = truth.elevation_max_rad(k, b);
      if (images.mask(k, b) == 0 || !(high - low > widest) || low < -half || high > half) continue;
      widest = high - low;
      found.beam = b;
      found.bin = k;
      found.elevation_min_rad = low;
      found.elevation_max_rad = high;
    }
  }
  found.range_m = found.geometry.bin_centre_m(found.bin);
}

Image2<std::uint8_t> seen(const Image2<std::uint8_t>& image) { return resized(image, 320, 320); }

/// Labels as grey levels that are told apart.
Image2<std::uint8_t> seen_labels(const Image2<std::uint8_t>& labels) {
  Image2<std::uint8_t> image = labels;
  for (auto& pixel : image.pixels()) pixel = static_cast<std::uint8_t>(pixel * 51);
  return seen(image);
}

}  // namespace

SonarPictures sonar_pictures() {
  const SonarModel sonar = load_sonar("oculus_m1200d_hf", {0.1, 5.0, 512});
  const Simulator simulator(open_scene(std::string("pier_harbor")), sonar, load_noise("paper"));
  const auto [ping, images, sampled] = simulator.ping({where(), {}, ping_keys(0, 0)});
  SonarPictures found;
  found.geometry = sonar.geometry;
  find_pixel(ping.truth, images, found);
  found.from_above =
      above(ping.truth, sonar.geometry, sonar.geometry.beam_azimuth_rad[static_cast<std::size_t>(found.beam)]);
  found.from_the_side = side(ping.truth, found);
  found.images = {"",
                  {{"range downwards, port on the left",
                    {{"raw", {seen(images.raw.grey)}},
                     {"clean", {seen(images.clean.grey)}},
                     {"mask", {seen(images.mask)}},
                     {"labels: water, direct, shadow", {seen_labels(images.labels)}}}},
                   {"as an operator sees it", {{"raw", {fan_view(images.raw.grey, sonar.geometry, 360)}}}}}};
  return found;
}

}  // namespace ensonify
