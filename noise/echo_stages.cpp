#include "ensonify/noise/echo_stages.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "ensonify/noise/gamma_quantile.hpp"
#include "ensonify/noise/random_row.hpp"

namespace ensonify {
namespace {

Image2<float> jittered(const Image2<float>& power, const SonarGeometry& geometry, double sigma_m, RandomKey key) {
  Image2<float> moved(power.rows(), power.columns());
  const auto sigma_bins = static_cast<float>(sigma_m / geometry.bin_size_m());
  std::vector<float> uniform(static_cast<std::size_t>(power.columns()));
  for (int bin = 0; bin < power.rows(); ++bin) {
    const auto in = power.row(bin);
    if (std::all_of(in.begin(), in.end(), [](float p) { return p == 0.0f; })) continue;
    uniform_row(key, static_cast<std::uint32_t>(bin), uniform);
    for (int b = 0; b < power.columns(); ++b) {
      // x = -sigma ln u is exponential, and exp(-x / sigma) is u again. ln u = -Rayleigh(u)^2 / 2.
      const float rayleigh = rayleigh_of(uniform[b]);
      const float away = static_cast<float>(bin) + 0.5f + sigma_bins * 0.5f * rayleigh * rayleigh;
      if (away < static_cast<float>(power.rows())) moved(static_cast<int>(away), b) += uniform[b] * in[b];
    }
  }
  return moved;
}

struct LayerDisturbance {
  Echo& echo;
  const Echo& traced;
  const SonarGeometry& geometry;
  SurfaceCells& cells;
  const PingSetting& setting;
  const std::string& name;

  void operator()(const Multipath<double>& stage) const {
    if (traced.multipath.empty()) throw std::logic_error("a multipath stage needs an echo whose multipath was traced");
    echo.multipath = traced.multipath;
    const auto gain = static_cast<float>(std::pow(10.0, 0.1 * stage.level_db));
    for (float& p : echo.multipath.pixels()) p *= gain;
  }

  void operator()(const Texture<double>& stage) const {
    const GammaQuantile gamma(stage.nu);
    const RandomKey key = setting.surface.child(name);
    constexpr std::size_t chunk = 32;  // of beams: most of an image is dark
    std::array<float, chunk> numbers;
    const auto beams = static_cast<std::size_t>(echo.direct.columns());
    for (int bin = 0; bin < echo.direct.rows(); ++bin) {
      for (std::size_t first = 0; first < beams; first += chunk) {
        const std::size_t count = std::min(chunk, beams - first);
        const auto power = echo.direct.row(bin).subspan(first, count);
        if (std::all_of(power.begin(), power.end(), [](float p) { return p == 0.0f; })) continue;
        const auto texture = std::span(numbers).first(count);
        cells.patches(key, bin, first, elevations(bin, first, count), static_cast<float>(stage.patch_m), texture);
        gamma.apply(texture);
        for (std::size_t b = 0; b < count; ++b) power[b] *= texture[b];
      }
    }
  }

  void operator()(const RangeJitter<double>& stage) const {
    if (stage.sigma_m <= 0.0) return;
    const RandomKey key = setting.ping.child(name);
    echo.direct = jittered(echo.direct, geometry, stage.sigma_m, key.child("direct"));
    if (!echo.multipath.empty()) {
      echo.multipath = jittered(echo.multipath, geometry, stage.sigma_m, key.child("multipath"));
    }
  }

  template <typename Stage>
  void operator()(const Stage&) const {}

 private:
  std::span<const float> elevations(int bin, std::size_t first, std::size_t count) const {
    if (echo.elevation_rad.empty()) return {};
    return std::as_const(echo.elevation_rad).row(bin).subspan(first, count);
  }
};

}  // namespace

Echo disturb_layers(const NoiseChain& chain, const Echo& echo, const SonarGeometry& geometry, SurfaceCells& cells,
                    const PingSetting& setting) {
  Echo result{echo.direct, {}, echo.elevation_rad};
  const std::vector<std::string> names = stage_names(chain.stages);
  for (std::size_t i = 0; i < chain.stages.size(); ++i) {
    std::visit(LayerDisturbance{result, echo, geometry, cells, setting, names[i]}, chain.stages[i]);
  }
  return result;
}

}  // namespace ensonify
