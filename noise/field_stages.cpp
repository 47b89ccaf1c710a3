#include "ensonify/noise/field_stages.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>

#include "ensonify/noise/random_row.hpp"
#include "ensonify/noise/scatter_field.hpp"
#include "ensonify/sensor_models/fan_pattern.hpp"
#include "ensonify/sensor_models/receive_chain.hpp"

namespace ensonify {
namespace {

constexpr double power_of_db(double db) { return std::pow(10.0, 0.1 * db); }
constexpr double amplitude_of_db(double db) { return std::pow(10.0, 0.05 * db); }

/// Far copies of a channel are left out.
constexpr int most_copies = 8;
constexpr double least_copy_db = -80.0;
/// Of an interfering pulse in the beams that do not look at it.
constexpr float aside = 0.05f;
constexpr int ring_knot_beams = 8;

/// Integral of the two-way pattern over elevation: the equivalent angle that a beam fills with sound (Urick 1983, 8.3).
double elevation_integral_rad(const Aperture& elevation) {
  constexpr int steps = 2000;
  double sum = 0.0;
  for (int i = 0; i < steps; ++i) {
    const double phi = std::numbers::pi * ((i + 0.5) / steps - 0.5);
    const double one_way = elevation.power(std::sin(phi));
    sum += one_way * one_way * std::cos(phi);
  }
  return sum * std::numbers::pi / steps;
}

/// Mean power before the array, of bins times of beams.
struct WhitePower {
  std::vector<float> of_bin, of_beam;
};

/// Of receiver noise, of which every beam hears as much, or of the water's own echo.
WhitePower white_power(const NoiseStage<double>& stage, const Receiver& receiver, double absorption_db_per_m) {
  const SonarModel& sonar = receiver.sonar;
  const SonarGeometry& g = sonar.geometry;
  std::vector<float> power(static_cast<std::size_t>(g.range_bins), 0.0f);
  std::vector<float> across(static_cast<std::size_t>(g.beams()), 1.0f);
  if (const auto* noise = std::get_if<ReceiverNoise<double>>(&stage)) {
    const std::vector<float> gains = row_gains(sonar);
    const double before_tvg = power_of_db(noise->level_db) / static_cast<double>(gains.back());
    const double behind_tvg = power_of_db(noise->floor_db);
    for (int bin = 0; bin < g.range_bins; ++bin) {
      power[bin] = static_cast<float>(before_tvg + behind_tvg / static_cast<double>(gains[bin]));
    }
    for (std::size_t b = 0; b < across.size(); ++b) {
      across[b] = static_cast<float>(1.0 / receiver.coherent.noise_gain()[b]);
    }
  }
  if (const auto* water = std::get_if<VolumeReverberation<double>>(&stage)) {
    const std::vector<double> edges = g.beam_edges_rad();
    const FanPattern pattern(sonar);
    const double arc = elevation_integral_rad(sonar.elevation);
    for (std::size_t b = 0; b < across.size(); ++b) {
      const double cell_rad = g.beams() > 1 ? edges[b] - edges[b + 1] : sonar.receive_azimuth.width_rad();
      across[b] = static_cast<float>(cell_rad * arc * pattern(g.beam_azimuth_rad[b]));
    }
    for (int bin = 0; bin < g.range_bins; ++bin) {
      const double r = g.bin_centre_m(bin);
      // Volume r^2 dr times solid angle, spreading r^-4.
      power[bin] = static_cast<float>(power_of_db(water->strength_db) * g.bin_size_m() / (r * r) *
                                      power_of_db(-2.0 * absorption_db_per_m * r));
    }
  }
  return {std::move(power), std::move(across)};
}

void add_scaled(const float* __restrict in, const float* __restrict across, float factor, std::span<float> row) {
  float* __restrict out = row.data();
  for (std::size_t b = 0; b < row.size(); ++b) out[b] += factor * across[b] * in[b];
}

/// Adds a copy of a row that lies `away` beams aside.
void add_aside(const float* __restrict in, int beams, int away, float factor, float* __restrict out) {
  const int last = std::min(beams, beams - away);
  for (int b = std::max(0, -away); b < last; ++b) out[b] += factor * in[b + away];
}

/// Sums of rows that follow each other, each added up in order: eight at a time, because every sum waits for its own
/// last addition.
std::array<float, 8> sums_of_rows(const float* first, int rows, int beams) {
  std::array<float, 8> sums{};
  std::array<const float*, 8> row;
  for (int r = 0; r < 8; ++r) row[r] = first + static_cast<std::ptrdiff_t>(std::min(r, rows - 1)) * beams;
  for (int b = 0; b < beams; ++b) {
    for (int r = 0; r < 8; ++r) sums[r] += row[r][b];
  }
  return sums;
}

struct FieldDisturbance {
  ComplexField& field;
  const Receiver& receiver;
  const PingSetting& setting;
  const std::vector<float>& gains;  ///< of the receive chain: power over full scale
  const std::string& name;

  int bins() const { return field.real.rows(); }
  int beams() const { return field.real.columns(); }

  void operator()(const RingDown<double>& stage) const {
    const RandomKey key = setting.device.child(name);
    const int knots = beams() / ring_knot_beams + 2;
    std::vector<float> numbers(2 * static_cast<std::size_t>(knots));
    for (int bin = 0; bin < bins(); ++bin) {
      const double r = receiver.sonar.geometry.bin_centre_m(bin);
      const double over_full_scale = power_of_db(stage.level_db) * std::exp(-r / stage.decay_m);
      if (over_full_scale < 1e-9) break;
      const double power = over_full_scale / static_cast<double>(gains[bin]);
      uniform_row(key, static_cast<std::uint32_t>(bin), numbers);
      to_normal(numbers);
      const auto scale = static_cast<float>(std::sqrt(0.5 * power));
      for (int b = 0; b < beams(); ++b) {
        const int k = b / ring_knot_beams;
        const float t = static_cast<float>(b % ring_knot_beams) / ring_knot_beams;
        const float norm = scale / std::sqrt(t * t + (1.0f - t) * (1.0f - t));
        field.real(bin, b) += norm * ((1.0f - t) * numbers[k] + t * numbers[k + 1]);
        field.imaginary(bin, b) += norm * ((1.0f - t) * numbers[knots + k] + t * numbers[knots + k + 1]);
      }
    }
  }

  void operator()(const SidelobeArcs<double>& stage) const {
    const auto leak = static_cast<float>(amplitude_of_db(stage.level_db));
    std::vector<float> phase(static_cast<std::size_t>(beams()));
    uniform_row(setting.device.child(name), 0, phase);
    std::vector<float> cosine, sine;
    for (const float p : phase) {
      cosine.push_back(std::cos(2.0f * std::numbers::pi_v<float> * p));
      sine.push_back(std::sin(2.0f * std::numbers::pi_v<float> * p));
    }
    for (int bin = 0; bin < bins(); ++bin) {
      const auto re = field.real.row(bin);
      const auto im = field.imaginary.row(bin);
      float sum_re = 0.0f;
      float sum_im = 0.0f;
      for (std::size_t b = 0; b < re.size(); ++b) {
        sum_re += re[b] * cosine[b] - im[b] * sine[b];
        sum_im += re[b] * sine[b] + im[b] * cosine[b];
      }
      sum_re *= leak;
      sum_im *= leak;
      for (std::size_t b = 0; b < re.size(); ++b) {
        re[b] += sum_re * cosine[b] + sum_im * sine[b];
        im[b] += sum_im * cosine[b] - sum_re * sine[b];
      }
    }
  }

  void operator()(const CrossTalk<double>& stage) const {
    const int period = std::max(1, static_cast<int>(std::lround(stage.period_beams)));
    std::vector<float> re(static_cast<std::size_t>(beams()));
    std::vector<float> im = re;
    for (int bin = 0; bin < bins(); ++bin) {
      float* out_re = field.real.row(bin).data();
      float* out_im = field.imaginary.row(bin).data();
      std::copy_n(out_re, beams(), re.begin());
      std::copy_n(out_im, beams(), im.begin());
      for_copies(stage, [&](int copy, double db) {
        const auto leak = static_cast<float>(amplitude_of_db(db));
        for (const int away : {copy * period, -copy * period}) {
          add_aside(re.data(), beams(), away, leak, out_re);
          add_aside(im.data(), beams(), away, leak, out_im);
        }
      });
    }
  }

  void operator()(const Interference<double>& stage) const {
    RandomSequence random(setting.ping.child(name));
    const int pulses = static_cast<int>(stage.pulses + random.uniform());
    const int length =
        std::max(1, static_cast<int>(std::lround(stage.length_m / receiver.sonar.geometry.bin_size_m())));
    for (int pulse = 0; pulse < pulses; ++pulse) {
      const int first = random.below(bins());
      const auto& azimuth = receiver.sonar.geometry.beam_azimuth_rad;
      const double bearing = std::sin(azimuth[static_cast<std::size_t>(random.below(beams()))]);
      for (int bin = first; bin < std::min(first + length, bins()); ++bin) {
        const double angle = 2.0 * std::numbers::pi * random.uniform();
        const double level = amplitude_of_db(stage.level_db) / std::sqrt(static_cast<double>(gains[bin]));
        for (int b = 0; b < beams(); ++b) {
          const double main = receiver.sonar.receive_azimuth.amplitude(std::sin(azimuth[b]) - bearing);
          const double amplitude = level * std::max(std::abs(main), static_cast<double>(aside));
          field.real(bin, b) += static_cast<float>(amplitude * std::cos(angle));
          field.imaginary(bin, b) += static_cast<float>(amplitude * std::sin(angle));
        }
      }
    }
  }

  template <typename Stage>
  void operator()(const Stage&) const {}

  template <typename Each>
  static void for_copies(const CrossTalk<double>& stage, const Each& each) {
    for (int copy = 1; copy <= most_copies; ++copy) {
      const double db = stage.level_db - (copy - 1) * stage.decay_db;
      if (db >= least_copy_db) each(copy, db);
    }
  }
};

}  // namespace

bool add_white_sources(const NoiseChain& chain, const Receiver& receiver, const PingSetting& setting,
                       ComplexField& field) {
  bool any = false;
  const auto beams = static_cast<std::size_t>(field.real.columns());
  std::vector<float> numbers(2 * beams);
  const std::vector<std::string> names = stage_names(chain.stages);
  for (std::size_t i = 0; i < chain.stages.size(); ++i) {
    const auto& stage = chain.stages[i];
    if (!std::holds_alternative<ReceiverNoise<double>>(stage) &&
        !std::holds_alternative<VolumeReverberation<double>>(stage)) {
      continue;
    }
    any = true;
    const WhitePower power = white_power(stage, receiver, setting.absorption_db_per_m);
    std::vector<float> across(beams);
    for (std::size_t b = 0; b < beams; ++b) across[b] = std::sqrt(power.of_beam[b]);
    const RandomKey key = setting.ping.child(names[i]);
    for (int bin = 0; bin < field.real.rows(); ++bin) {
      uniform_row(key, static_cast<std::uint32_t>(bin), numbers);
      to_normal(numbers);
      const float scale = std::sqrt(0.5f * power.of_bin[bin]);
      add_scaled(numbers.data(), across.data(), scale, field.real.row(bin));
      add_scaled(numbers.data() + beams, across.data(), scale, field.imaginary.row(bin));
    }
  }
  return any;
}

void disturb_field(const NoiseChain& chain, const Receiver& receiver, const PingSetting& setting, ComplexField& field) {
  const std::vector<float> gains = row_gains(receiver.sonar);
  const std::vector<std::string> names = stage_names(chain.stages);
  for (std::size_t i = 0; i < chain.stages.size(); ++i) {
    std::visit(FieldDisturbance{field, receiver, setting, gains, names[i]}, chain.stages[i]);
  }
}

void add_leaked_power(const NoiseChain& chain, const Receiver& receiver, const Image2<float>& power,
                      Image2<float>& leaked) {
  if (const auto* arcs = chain.find<SidelobeArcs>()) {
    const std::vector<double>& gain = receiver.coherent.noise_gain();
    const auto leak = static_cast<float>(power_of_db(arcs->level_db) * gain[gain.size() / 2]);
    for (int first = 0; first < power.rows(); first += 8) {
      const int rows = std::min(8, power.rows() - first);
      const std::array<float, 8> sums = sums_of_rows(power.row(first).data(), rows, power.columns());
      for (int r = 0; r < rows; ++r) {
        const float sum = leak * sums[r];
        for (float& p : leaked.row(first + r)) p += sum;
      }
    }
  }
  if (const auto* talk = chain.find<CrossTalk>()) {
    const int period = std::max(1, static_cast<int>(std::lround(talk->period_beams)));
    const int beams = power.columns();
    const Image2<float> channels = receiver.spread.apply(power);
    for (int bin = 0; bin < power.rows(); ++bin) {
      const float* in = channels.row(bin).data();
      float* out = leaked.row(bin).data();
      FieldDisturbance::for_copies(*talk, [&](int copy, double db) {
        const auto leak = static_cast<float>(power_of_db(db));
        for (const int away : {copy * period, -copy * period}) add_aside(in, beams, away, leak, out);
      });
    }
  }
}

}  // namespace ensonify
