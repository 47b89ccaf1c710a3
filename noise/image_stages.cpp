#include "ensonify/noise/image_stages.hpp"

#include <algorithm>
#include <cmath>
#include <functional>

#include "ensonify/noise/random_row.hpp"

namespace ensonify {
namespace {

/// One stage acting on a whole image.
struct ImageDisturbance {
  Image2<float>& level;
  const SonarGeometry& geometry;
  RandomKey key;

  void operator()(const GaussianSpeckle<double>& stage) const {
    const auto sigma = static_cast<float>(stage.sigma);
    each_row_with_numbers(to_normal, [&](int, std::span<float> row, std::span<const float> normal) {
      for (std::size_t b = 0; b < row.size(); ++b) row[b] *= 1.0f + sigma * normal[b];
    });
  }

  void operator()(const AdditiveRayleigh<double>& stage) const {
    const auto sigma = static_cast<float>(stage.sigma);
    each_row_with_numbers(to_rayleigh, [&](int, std::span<float> row, std::span<const float> rayleigh) {
      for (std::size_t b = 0; b < row.size(); ++b) row[b] += sigma * rayleigh[b];
    });
  }

  void operator()(const RangeNoise<double>& stage) const {
    std::vector<float> lobe;
    const double fan_deg = degrees(geometry.beam_azimuth_rad.front() - geometry.beam_azimuth_rad.back());
    for (const double azimuth : geometry.beam_azimuth_rad) {
      const double a = degrees(azimuth);
      lobe.push_back(
          static_cast<float>(1.0 + (fan_deg > 0.0 ? stage.centre * std::exp(-a * a / (fan_deg / 64)) : 0.0)));
    }
    each_row_with_numbers(to_rayleigh, [&](int bin, std::span<float> row, std::span<const float> rayleigh) {
      const double place = geometry.bin_centre_m(bin) / geometry.range_max_m;
      const auto sigma = static_cast<float>(stage.sigma * std::pow(place, stage.exponent));
      for (std::size_t b = 0; b < row.size(); ++b) row[b] += sigma * lobe[b] * rayleigh[b];
    });
  }

  void operator()(const CentreStripe<double>& stage) const {
    std::vector<float> factor;
    for (int b = 0; b < level.columns(); ++b) {
      const double off = (b - 0.5 * (level.columns() - 1)) / stage.width_beams;
      factor.push_back(static_cast<float>(1.0 + (stage.gain - 1.0) * std::exp(-0.5 * off * off)));
    }
    each_row([&](int, std::span<float> row) {
      for (std::size_t b = 0; b < row.size(); ++b) row[b] *= factor[b];
    });
  }

  void operator()(const NearEdges<double>& stage) const {
    std::vector<float> edge;
    for (int b = 0; b < level.columns(); ++b) {
      const double off = level.columns() > 1 ? std::abs(2.0 * b / (level.columns() - 1) - 1.0) : 0.0;
      edge.push_back(static_cast<float>(std::pow(off, 6.0)));  // flat over most of the fan, as in the recorded pings
    }
    each_row([&](int bin, std::span<float> row) {
      const auto gain = static_cast<float>((stage.gain - 1.0) * std::exp(-geometry.bin_centre_m(bin) / stage.reach_m));
      for (std::size_t b = 0; b < row.size(); ++b) row[b] *= 1.0f + gain * edge[b];
    });
  }

  void operator()(const GainWobble<double>& stage) const {
    std::vector<float> factor(static_cast<std::size_t>(level.columns()));
    uniform_row(key, 0, factor);
    to_normal(factor);
    for (float& f : factor) f = std::max(0.0f, 1.0f + static_cast<float>(stage.sigma) * f);
    each_row([&](int, std::span<float> row) {
      for (std::size_t b = 0; b < row.size(); ++b) row[b] *= factor[b];
    });
  }

  void operator()(const DroppedBeams<double>& stage) const {
    std::vector<float> alive(static_cast<std::size_t>(level.columns()));
    uniform_row(key, 0, alive);
    for (float& a : alive) a = a < static_cast<float>(stage.probability) ? 0.0f : 1.0f;
    each_row([&](int, std::span<float> row) {
      for (std::size_t b = 0; b < row.size(); ++b) row[b] *= alive[b];
    });
  }

  void operator()(const AzimuthStreaks<double>& stage) const {
    const auto strength = static_cast<float>(stage.strength);
    each_row([&](int, std::span<float> row) {
      const auto bright = std::count_if(row.begin(), row.end(), [](float v) { return v > 0.5f; });
      if (static_cast<double>(bright) < stage.share * static_cast<double>(row.size())) return;
      for (float& v : row) {
        v = std::min(v, 1.0f);
        v += strength * v * (1.0f - v);  // strength -1: v^2; 1: 1 - (1 - v)^2
      }
    });
  }

  /// Stages of the other domains have had their turn.
  template <typename Stage>
  void operator()(const Stage&) const {}

 private:
  template <typename Each>
  void each_row(const Each& each) const {
    for (int bin = 0; bin < level.rows(); ++bin) each(bin, level.row(bin));
  }

  template <typename Each>
  void each_row_with_numbers(void (*shape)(std::span<float>), const Each& each) const {
    std::vector<float> numbers(static_cast<std::size_t>(level.columns()));
    for (int bin = 0; bin < level.rows(); ++bin) {
      uniform_row(key, static_cast<std::uint32_t>(bin), numbers);
      shape(numbers);
      each(bin, level.row(bin), numbers);
    }
  }
};

}  // namespace

Image2<float> disturb_image(const NoiseChain& chain, Image2<float> level, const SonarGeometry& geometry,
                            RandomKey key) {
  const std::vector<std::string> names = stage_names(chain.stages);
  for (std::size_t i = 0; i < chain.stages.size(); ++i) {
    std::visit(ImageDisturbance{level, geometry, key.child(names[i])}, chain.stages[i]);
  }
  for (float& v : level.pixels()) v = std::min(std::max(v, 0.0f), 1.0f);
  return level;
}

}  // namespace ensonify
