#pragma once

#include <array>
#include <optional>
#include <variant>

#include "ensonify/config/reader.hpp"

/// The closed set of disturbances. Every number of a stage is a `Value`: a Distribution in a profile, a double once it
/// is drawn. A new stage is a struct here, an entry in NoiseStage, and an overload in the file of its domain.
namespace ensonify {

/// What a stage works on; a chain goes through them in this order.
enum class NoiseDomain {
  echo,     ///< mean intensity of the layers, before speckle
  speckle,  ///< how mean intensity becomes a field: at most one
  field,    ///< complex amplitude at the receiver
  image,    ///< level 0..1 after TVG and gamma
};

template <typename Stage, typename Value>
struct Parameter {
  const char* name;
  Value Stage::*member;
  Limits limits;
  std::optional<double> otherwise = {};  ///< where the profile is silent; none: required
};

/// Adds the multipath layer, at `level_db` over what was traced. `order`: most surfaces that a path meets. `samples`:
/// pairs of places tried, over the usual.
template <typename Value>
struct Multipath {
  static constexpr const char* kind = "multipath";
  static constexpr NoiseDomain domain = NoiseDomain::echo;
  Value level_db, order, samples;
  static constexpr auto parameters() {
    return std::array{Parameter<Multipath, Value>{"level_db", &Multipath::level_db, {-60, 20}, 0.0},
                      Parameter<Multipath, Value>{"order", &Multipath::order, {2, 3}, 2.0},
                      Parameter<Multipath, Value>{"samples", &Multipath::samples, {0.1, 64}, 1.0}};
  }
};

/// Patches of `patch_m` whose power is gamma distributed about its mean, fixed to the surface: with coherent speckle
/// clutter is then K distributed of shape nu (Jakeman and Pusey 1976; Abraham and Lyons 2002).
template <typename Value>
struct Texture {
  static constexpr const char* kind = "texture";
  static constexpr NoiseDomain domain = NoiseDomain::echo;
  Value nu, patch_m;
  static constexpr auto parameters() {
    return std::array{Parameter<Texture, Value>{"nu", &Texture::nu, {0.1, 1000}},
                      Parameter<Texture, Value>{"patch_m", &Texture::patch_m, {0.001, 100}}};
  }
};

/// Every echo moves away by an exponential x of mean sigma_m and weakens by exp(-x / sigma_m): RangeSigma of HoloOcean.
template <typename Value>
struct RangeJitter {
  static constexpr const char* kind = "range_jitter";
  static constexpr NoiseDomain domain = NoiseDomain::echo;
  Value sigma_m;
  static constexpr auto parameters() {
    return std::array{Parameter<RangeJitter, Value>{"sigma_m", &RangeJitter::sigma_m, {0, 10}}};
  }
};

/// Random scatterers fixed to the surface, through pulse and array as complex amplitudes (Goodman 2007, ch. 2).
template <typename Value>
struct CoherentSpeckle {
  static constexpr const char* kind = "coherent_speckle";
  static constexpr NoiseDomain domain = NoiseDomain::speckle;
  static constexpr auto parameters() { return std::array<Parameter<CoherentSpeckle, Value>, 0>{}; }
};

/// Incoherent: every pixel's intensity times an exponential number, that is a Rayleigh amplitude.
template <typename Value>
struct RayleighSpeckle {
  static constexpr const char* kind = "rayleigh_speckle";
  static constexpr NoiseDomain domain = NoiseDomain::speckle;
  static constexpr auto parameters() { return std::array<Parameter<RayleighSpeckle, Value>, 0>{}; }
};

/// Incoherent: intensity times Gamma(looks) / looks.
template <typename Value>
struct GammaSpeckle {
  static constexpr const char* kind = "gamma_speckle";
  static constexpr NoiseDomain domain = NoiseDomain::speckle;
  Value looks;
  static constexpr auto parameters() {
    return std::array{Parameter<GammaSpeckle, Value>{"looks", &GammaSpeckle::looks, {0.1, 1000}}};
  }
};

/// Incoherent: intensity times an exponential number times Gamma(nu) / nu.
template <typename Value>
struct KSpeckle {
  static constexpr const char* kind = "k_speckle";
  static constexpr NoiseDomain domain = NoiseDomain::speckle;
  Value nu;
  static constexpr auto parameters() {
    return std::array{Parameter<KSpeckle, Value>{"nu", &KSpeckle::nu, {0.1, 1000}}};
  }
};

/// Echo of the water itself, new in every ping. `strength_db`: volume scattering strength, dB re 1/m (Urick 1983, 8.7).
/// Occlusion is not accounted for.
template <typename Value>
struct VolumeReverberation {
  static constexpr const char* kind = "volume_reverberation";
  static constexpr NoiseDomain domain = NoiseDomain::field;
  Value strength_db;
  static constexpr auto parameters() {
    return std::array{
        Parameter<VolumeReverberation, Value>{"strength_db", &VolumeReverberation::strength_db, {-150, 0}}};
  }
};

/// Complex Gaussian noise, new in every ping, through the array as the echo is. Mean power in dB of full scale:
/// `level_db` at the end of the range window, less with the TVG at shorter ranges (a device sets its gain to the
/// window); `floor_db` at every range (behind the TVG).
template <typename Value>
struct ReceiverNoise {
  static constexpr const char* kind = "receiver_noise";
  static constexpr NoiseDomain domain = NoiseDomain::field;
  Value level_db, floor_db;
  static constexpr auto parameters() {
    return std::array{Parameter<ReceiverNoise, Value>{"level_db", &ReceiverNoise::level_db, {-200, 0}},
                      Parameter<ReceiverNoise, Value>{"floor_db", &ReceiverNoise::floor_db, {-200, 0}, -200.0}};
  }
};

/// The transducer rings after the pulse: a pattern of the device, `level_db` of full scale at range 0, falling to 1/e
/// of its power in `decay_m`.
template <typename Value>
struct RingDown {
  static constexpr const char* kind = "ring_down";
  static constexpr NoiseDomain domain = NoiseDomain::field;
  Value level_db, decay_m;
  static constexpr auto parameters() {
    return std::array{Parameter<RingDown, Value>{"level_db", &RingDown::level_db, {-100, 20}},
                      Parameter<RingDown, Value>{"decay_m", &RingDown::decay_m, {0.001, 100}}};
  }
};

/// A strong target shows in all beams at its range: every beam receives the sum over the fan, `level_db` down
/// (array errors; physics of far sidelobes).
template <typename Value>
struct SidelobeArcs {
  static constexpr const char* kind = "sidelobe_arcs";
  static constexpr NoiseDomain domain = NoiseDomain::field;
  Value level_db;
  static constexpr auto parameters() {
    return std::array{Parameter<SidelobeArcs, Value>{"level_db", &SidelobeArcs::level_db, {-120, 0}}};
  }
};

/// Channels leak into those `period_beams` away, `level_db` down, and into further multiples, each `decay_db` weaker
/// (DIDSON: period 8).
template <typename Value>
struct CrossTalk {
  static constexpr const char* kind = "cross_talk";
  static constexpr NoiseDomain domain = NoiseDomain::field;
  Value level_db, period_beams, decay_db;
  static constexpr auto parameters() {
    return std::array{Parameter<CrossTalk, Value>{"level_db", &CrossTalk::level_db, {-120, 0}},
                      Parameter<CrossTalk, Value>{"period_beams", &CrossTalk::period_beams, {1, 2048}},
                      Parameter<CrossTalk, Value>{"decay_db", &CrossTalk::decay_db, {0.5, 100}, 3.0}};
  }
};

/// Pulses of another sonar that is not synchronised: `pulses` a ping in the mean, each over `length_m` of range, at
/// `level_db` of full scale in the beam that looks at it and 26 dB less in the others.
template <typename Value>
struct Interference {
  static constexpr const char* kind = "interference";
  static constexpr NoiseDomain domain = NoiseDomain::field;
  Value pulses, level_db, length_m;
  static constexpr auto parameters() {
    return std::array{Parameter<Interference, Value>{"pulses", &Interference::pulses, {0, 100}},
                      Parameter<Interference, Value>{"level_db", &Interference::level_db, {-100, 20}},
                      Parameter<Interference, Value>{"length_m", &Interference::length_m, {0.001, 10}, 0.02}};
  }
};

/// level <- level * (1 + sigma N(0, 1)): the multiplicative speckle of HoloOcean, Stonefish and Lin et al. (ICRA 2023).
/// Acts after gamma, so it is no model of real speckle.
template <typename Value>
struct GaussianSpeckle {
  static constexpr const char* kind = "gaussian_speckle";
  static constexpr NoiseDomain domain = NoiseDomain::image;
  Value sigma;
  static constexpr auto parameters() {
    return std::array{Parameter<GaussianSpeckle, Value>{"sigma", &GaussianSpeckle::sigma, {0, 10}}};
  }
};

/// level <- level + Rayleigh(sigma): the additive noise of HoloOcean and Lin et al. (ICRA 2023). Mean 1.2533 sigma.
template <typename Value>
struct AdditiveRayleigh {
  static constexpr const char* kind = "additive_rayleigh";
  static constexpr NoiseDomain domain = NoiseDomain::image;
  Value sigma;
  static constexpr auto parameters() {
    return std::array{Parameter<AdditiveRayleigh, Value>{"sigma", &AdditiveRayleigh::sigma, {0, 10}}};
  }
};

/// level <- level + Rayleigh(sigma) (r / range_max)^exponent (1 + centre exp(-theta^2 / (fan / 64))): HoloOcean's
/// ScaleNoise, with theta and the fan's width in degrees, exponent 2 and centre 0.5.
template <typename Value>
struct RangeNoise {
  static constexpr const char* kind = "range_noise";
  static constexpr NoiseDomain domain = NoiseDomain::image;
  Value sigma, exponent, centre;
  static constexpr auto parameters() {
    return std::array{Parameter<RangeNoise, Value>{"sigma", &RangeNoise::sigma, {0, 10}},
                      Parameter<RangeNoise, Value>{"exponent", &RangeNoise::exponent, {0, 8}, 2.0},
                      Parameter<RangeNoise, Value>{"centre", &RangeNoise::centre, {0, 10}, 0.0}};
  }
};

/// The middle of the fan is brighter by the factor `gain`, over a Gaussian of standard deviation `width_beams`.
template <typename Value>
struct CentreStripe {
  static constexpr const char* kind = "centre_stripe";
  static constexpr NoiseDomain domain = NoiseDomain::image;
  Value gain, width_beams;
  static constexpr auto parameters() {
    return std::array{Parameter<CentreStripe, Value>{"gain", &CentreStripe::gain, {0, 10}},
                      Parameter<CentreStripe, Value>{"width_beams", &CentreStripe::width_beams, {0.1, 2048}, 2.0}};
  }
};

/// The edges of the fan are brighter by the factor `gain` at range 0, less with range (1/e in `reach_m`).
template <typename Value>
struct NearEdges {
  static constexpr const char* kind = "near_edges";
  static constexpr NoiseDomain domain = NoiseDomain::image;
  Value gain, reach_m;
  static constexpr auto parameters() {
    return std::array{Parameter<NearEdges, Value>{"gain", &NearEdges::gain, {0, 10}},
                      Parameter<NearEdges, Value>{"reach_m", &NearEdges::reach_m, {0.01, 1000}}};
  }
};

/// Each beam's gain differs from ping to ping: factor 1 + sigma N(0, 1) over all its ranges.
template <typename Value>
struct GainWobble {
  static constexpr const char* kind = "gain_wobble";
  static constexpr NoiseDomain domain = NoiseDomain::image;
  Value sigma;
  static constexpr auto parameters() {
    return std::array{Parameter<GainWobble, Value>{"sigma", &GainWobble::sigma, {0, 1}}};
  }
};

/// Rows in which at least `share` of the beams exceed level 1/2 become darker (strength -1: v^2) or brighter
/// (1: 1 - (1 - v)^2): AzimuthStreaks of HoloOcean.
template <typename Value>
struct AzimuthStreaks {
  static constexpr const char* kind = "azimuth_streaks";
  static constexpr NoiseDomain domain = NoiseDomain::image;
  Value strength, share;
  static constexpr auto parameters() {
    return std::array{Parameter<AzimuthStreaks, Value>{"strength", &AzimuthStreaks::strength, {-1, 1}},
                      Parameter<AzimuthStreaks, Value>{"share", &AzimuthStreaks::share, {0, 1}, 0.08}};
  }
};

/// A beam is black in a ping with this probability.
template <typename Value>
struct DroppedBeams {
  static constexpr const char* kind = "dropped_beams";
  static constexpr NoiseDomain domain = NoiseDomain::image;
  Value probability;
  static constexpr auto parameters() {
    return std::array{Parameter<DroppedBeams, Value>{"probability", &DroppedBeams::probability, {0, 1}}};
  }
};

template <typename Value>
using NoiseStage =
    std::variant<Multipath<Value>, Texture<Value>, RangeJitter<Value>, CoherentSpeckle<Value>, RayleighSpeckle<Value>,
                 GammaSpeckle<Value>, KSpeckle<Value>, VolumeReverberation<Value>, ReceiverNoise<Value>,
                 RingDown<Value>, SidelobeArcs<Value>, CrossTalk<Value>, Interference<Value>, CentreStripe<Value>,
                 NearEdges<Value>, GainWobble<Value>, AzimuthStreaks<Value>, DroppedBeams<Value>, RangeNoise<Value>,
                 GaussianSpeckle<Value>, AdditiveRayleigh<Value>>;

}  // namespace ensonify
