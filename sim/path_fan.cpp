#include "ensonify/sim/path_fan.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace ensonify {
namespace {

constexpr int table_steps = 1024;
constexpr double by_pattern = 0.8;

/// Of a table equidistant over 0..1.
float looked_up(const std::vector<float>& table, float x) {
  const float place = x * table_steps;
  const int i = std::clamp(static_cast<int>(place), 0, table_steps - 1);
  return table[i] + (place - static_cast<float>(i)) * (table[i + 1] - table[i]);
}

}  // namespace

PathFan::PathFan(const SonarModel& sonar, const RayFan& fan, int columns) : columns_(columns) {
  const int beams = sonar.geometry.beams();
  const auto first_ray = [&](int beam) -> const RayFan::Column& { return fan.columns[beam * fan.rays_per_beam]; };
  const auto beam_edge = [&](int beam) {
    if (beam == beams) return fan.columns.back().azimuth_rad - 0.5f * fan.columns.back().width_rad;
    return first_ray(beam).azimuth_rad + 0.5f * first_ray(beam).width_rad;
  };
  for (int c = 0; c <= columns_; ++c) {
    const double x = static_cast<double>(c) * beams / columns_;
    const int beam = std::min(static_cast<int>(x), beams - 1);
    const double port = beam_edge(beam);
    edges_rad_.push_back(static_cast<float>(port + (x - beam) * (beam_edge(beam + 1) - port)));
    azimuth_gain_.push_back(std::sqrt(first_ray(beam).gain));
  }
  int column = 0;
  for (int i = 0; i <= table_steps; ++i) {
    const double azimuth = edges_rad_.front() + (edges_rad_.back() - edges_rad_.front()) * (1.0 * i / table_steps);
    while (column + 1 < columns_ && azimuth < edges_rad_[column + 1]) ++column;
    const double within = (edges_rad_[column] - azimuth) / (edges_rad_[column] - edges_rad_[column + 1]);
    u_at_azimuth_.push_back(static_cast<float>((column + std::clamp(within, 0.0, 1.0)) / columns_));
  }

  const float port = edges_rad_.front();
  const float starboard = edges_rad_.back();
  if (port - starboard < std::numbers::pi_v<float>) {
    borders_ = {Eigen::Vector3f(std::sin(port), -std::cos(port), 0.0f),
                Eigen::Vector3f(-std::sin(starboard), std::cos(starboard), 0.0f)};
  }

  // The rays' arc, which ends where the two-way pattern is 60 dB down.
  const std::vector<float>& elevations = fan.rows[0].elevation_rad;
  const double row = static_cast<double>(elevations.back() - elevations.front()) / (fan.elevation_rays - 1);
  const double half_sine = std::min(std::sin(0.5 * row * fan.elevation_rays), 0.9999);
  half_sine_ = static_cast<float>(half_sine);
  const double arc = 2.0 * std::asin(half_sine);
  std::vector<double> below{0.0};
  const auto phi_at = [&](double i) { return std::asin(half_sine * (2.0 * i / table_steps - 1.0)); };
  const auto pattern = [&](double i) { return sonar.elevation.power(half_sine * (2.0 * i / table_steps - 1.0)); };
  for (int i = 0; i < table_steps; ++i) below.push_back(below.back() + pattern(i + 0.5) * (phi_at(i + 1) - phi_at(i)));
  const double whole = below.back();
  for (int i = 0; i <= table_steps; ++i) {
    const double v = by_pattern * below[i] / whole + (1.0 - by_pattern) * (phi_at(i) + 0.5 * arc) / arc;
    const double density = by_pattern * pattern(i) / whole + (1.0 - by_pattern) / arc;
    elevation_.push_back({static_cast<float>(pattern(i)), static_cast<float>(v), static_cast<float>(density)});
  }
  int at = 0;
  for (int i = 0; i <= table_steps; ++i) {
    const float v = static_cast<float>(i) / table_steps;
    while (at + 1 < table_steps && elevation_[at + 1].below < v) ++at;
    const float within = (v - elevation_[at].below) / (elevation_[at + 1].below - elevation_[at].below);
    sine_at_v_.push_back(half_sine_ *
                         ((static_cast<float>(at) + std::clamp(within, 0.0f, 1.0f)) * (2.0f / table_steps) - 1.0f));
  }
}

Eigen::Vector3f PathFan::direction(float u, float v) const {
  const float place = u * static_cast<float>(columns_);
  const int c = std::clamp(static_cast<int>(place), 0, columns_ - 1);
  const float azimuth = edges_rad_[c] + (place - static_cast<float>(c)) * (edges_rad_[c + 1] - edges_rad_[c]);
  const float sine = looked_up(sine_at_v_, v);
  const float cosine = std::sqrt(1.0f - sine * sine);
  return {cosine * std::cos(azimuth), cosine * std::sin(azimuth), sine};
}

PathFan::Place PathFan::place_of(const Eigen::Vector3f& unit) const {
  const float height = (unit.z() / half_sine_ + 1.0f) * (0.5f * table_steps);
  const float along = (edges_rad_.front() - std::atan2(unit.y(), unit.x())) / (edges_rad_.front() - edges_rad_.back());
  if (!(height >= 0.0f && height < table_steps && along >= 0.0f && along < 1.0f)) return {};
  const float u = looked_up(u_at_azimuth_, along);
  const int column = std::min(static_cast<int>(u * static_cast<float>(columns_)), columns_ - 1);
  const auto j = static_cast<std::size_t>(height);
  const float up = height - static_cast<float>(j);
  const Elevation& low = elevation_[j];
  const Elevation& high = elevation_[j + 1];
  const float width = edges_rad_[column] - edges_rad_[column + 1];
  return {column,
          u,
          low.below + up * (high.below - low.below),
          (low.gain + up * (high.gain - low.gain)) * azimuth_gain_[column],
          width * static_cast<float>(columns_),
          1.0f / (low.density + up * (high.density - low.density))};
}

float PathFan::distance_within(const Eigen::Vector3f& place, const Eigen::Vector3f& unit) const {
  constexpr float never = std::numeric_limits<float>::max();
  // A wedge of less than half a turn is convex: what leaves it stays outside.
  float beside = never;
  for (const Eigen::Vector3f& inward : borders_) {
    const float depth = inward.dot(place);
    const float rate = inward.dot(unit);
    if (depth < 0.0f) return never;
    if (rate < 0.0f) beside = std::min(beside, depth / -rate);
  }
  // f(t) = a t^2 + 2 b t + c of the double cone z^2 = s^2 p^2 along p = place + t unit, negative within the fan. A ray
  // less steep than the cone (a <= 0) may leave over one nappe, but comes back.
  const float s2 = half_sine_ * half_sine_;
  const float a = unit.z() * unit.z() - s2;
  const float b = place.z() * unit.z() - s2 * place.dot(unit);
  const float c = place.z() * place.z() - s2 * place.squaredNorm();
  const float discriminant = b * b - a * c;
  if (c >= 0.0f || (a <= 0.0f && (b <= 0.0f || discriminant <= 0.0f))) return beside;
  // Roots in the form that does not cancel.
  const float root = std::sqrt(discriminant);
  const float leaves = b > 0.0f ? -c / (b + root) : (root - b) / a;
  const bool comes_back = a <= 0.0f && -c / (b - root) < beside;
  return comes_back ? beside : std::min(beside, leaves);
}

}  // namespace ensonify
