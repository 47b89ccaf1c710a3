#include "ensonify/sim/path_fan.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "ensonify/core/random.hpp"

namespace ensonify {
namespace {

constexpr int default_columns = 256;
constexpr int default_rows = 16;
constexpr int table_steps = 2048;
constexpr double by_pattern = 0.8;
constexpr double least_one_way_db = -30.0;

double fraction(double x) { return x - std::floor(x); }
double unit_of(std::uint32_t word) { return (word + 0.5) * 0x1p-32; }
std::uint32_t reversed3(std::uint32_t q) { return ((q & 1) << 2) | (q & 2) | (q >> 2); }

}  // namespace

PathFan::PathFan(const SonarModel& sonar, int density) {
  const RayFan fan(sonar);
  const double finer = std::sqrt(static_cast<double>(density));  // in points: pairs grow as their square
  columns_ = density > 1 ? 2 * default_columns : default_columns;
  rows_ = 2 * std::max(1, static_cast<int>(std::lround(0.5 * default_rows * finer * default_columns / columns_)));

  const int beams = sonar.geometry.beams();
  const auto ray_column = [&](int beam) -> const RayFan::Column& {
    return fan.columns[static_cast<std::size_t>(std::min(beam, beams - 1)) * static_cast<std::size_t>(fan.rays_per_beam)];
  };
  const auto beam_edge = [&](int beam) {
    const RayFan::Column& c = beam < beams ? ray_column(beam) : fan.columns.back();
    return c.azimuth_rad + (beam < beams ? 0.5f : -0.5f) * c.width_rad;
  };
  for (int c = 0; c <= columns_; ++c) {
    const double x = static_cast<double>(c) * beams / columns_;
    const int beam = std::min(static_cast<int>(x), beams - 1);
    const double port = beam_edge(beam);
    edges_rad_.push_back(static_cast<float>(port + (x - beam) * (beam_edge(beam + 1) - port)));
    azimuth_gain_.push_back(std::sqrt(ray_column(beam).gain));
  }
  int column = 0;
  for (int i = 0; i <= table_steps; ++i) {
    const double azimuth = edges_rad_.front() + (edges_rad_.back() - edges_rad_.front()) * (1.0 * i / table_steps);
    while (column + 1 < columns_ && azimuth < edges_rad_[column + 1]) ++column;
    const double within = (edges_rad_[column] - azimuth) / (edges_rad_[column] - edges_rad_[column + 1]);
    column_at_azimuth_.push_back(static_cast<float>(column + std::clamp(within, 0.0, 1.0)));
  }

  const double half_sine = sonar.elevation.sine_beyond_db(least_one_way_db);
  const double half_arc = std::asin(half_sine);
  half_arc_sine_ = static_cast<float>(half_sine);
  const auto pattern = [&](double phi) { return sonar.elevation.power(std::sin(phi)); };
  std::vector<double> below{0.0};  // integral of the pattern, over equal steps of phi
  const double step = 2.0 * half_arc / table_steps;
  for (int i = 0; i < table_steps; ++i) below.push_back(below.back() + step * pattern(-half_arc + (i + 0.5) * step));
  const double whole = below.back();
  const auto share_below = [&](int i) {
    return by_pattern * below[i] / whole + (1.0 - by_pattern) * i / table_steps;
  };
  for (int i = 0; i <= table_steps; ++i) {
    const double phi = std::asin(half_sine * (2.0 * i / table_steps - 1.0));
    elevation_.push_back({static_cast<float>(pattern(phi)),
                          static_cast<float>(by_pattern * pattern(phi) / whole + (1.0 - by_pattern) / (2.0 * half_arc))});
  }

  const RandomKey key = RandomKey::from_seed(0);  // no frame and no seed in it
  for (int row = 0; row < rows_; ++row) {
    int at = 0;
    for (int c = 0; c < columns_; ++c) {
      const auto tile = static_cast<std::uint32_t>(c / tile_columns);
      const auto q = static_cast<std::uint32_t>(c % tile_columns);
      const std::array<std::uint32_t, 4> own = random_words(key, static_cast<std::uint32_t>(c), row, 0);
      const std::array<std::uint32_t, 4> shared = random_words(key, tile, row, 1);
      const double height = (row + ((reversed3(q) ^ (shared[0] & 7)) + unit_of(own[0])) / tile_columns) / rows_;
      const auto above = [&](int i) { return share_below(i + 1) >= height; };
      if (share_below(at) > height) at = 0;
      while (at + 1 < table_steps && !above(at)) ++at;
      const double within = (height - share_below(at)) / (share_below(at + 1) - share_below(at));
      const double phi = -half_arc + (at + std::clamp(within, 0.0, 1.0)) * step;
      const double theta = edges_rad_[c] + (edges_rad_[c + 1] - edges_rad_[c]) * unit_of(own[1]);
      const double turn = 2.0 * std::numbers::pi * fraction(unit_of(shared[1]) + q * 0.7548776662466927);
      directions_.push_back({Eigen::Vector3d(std::cos(phi) * std::cos(theta), std::cos(phi) * std::sin(theta), std::sin(phi))
                                 .cast<float>(),
                             static_cast<float>(fraction(unit_of(shared[2]) + q * 0.618033988749895)),
                             static_cast<float>(fraction(unit_of(shared[3]) + q * 0.5698402909980532)),
                             static_cast<float>(std::cos(turn)), static_cast<float>(std::sin(turn))});
    }
  }
}

PathFan::Place PathFan::place_of(const Eigen::Vector3f& unit) const {
  if (!(std::abs(unit.z()) < half_arc_sine_)) return {};
  const float azimuth = std::atan2(unit.y(), unit.x());
  const float at = (edges_rad_.front() - azimuth) / (edges_rad_.front() - edges_rad_.back()) * table_steps;
  if (!(at >= 0.0f && at < table_steps)) return {};
  const auto i = static_cast<std::size_t>(at);
  const float share = at - static_cast<float>(i);
  const float x = column_at_azimuth_[i] + share * (column_at_azimuth_[i + 1] - column_at_azimuth_[i]);
  const int column = std::min(static_cast<int>(x), columns_ - 1);

  const float height = (unit.z() / half_arc_sine_ + 1.0f) * (0.5f * table_steps);
  const auto j = std::min(static_cast<std::size_t>(height), static_cast<std::size_t>(table_steps - 1));
  const float up = height - static_cast<float>(j);
  const float gain = elevation_[j].gain + up * (elevation_[j + 1].gain - elevation_[j].gain);
  const float density = elevation_[j].density + up * (elevation_[j + 1].density - elevation_[j].density);
  const float width = edges_rad_[column] - edges_rad_[column + 1];
  const float per_rad = density * static_cast<float>(rows_);
  const float cosine = std::sqrt(1.0f - unit.z() * unit.z());
  return {column, gain * azimuth_gain_[column], per_rad / (width * cosine), tile_columns * width, 1.0f / per_rad};
}

}  // namespace ensonify
