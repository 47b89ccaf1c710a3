#pragma once

#include "ensonify/core/echo.hpp"
#include "ensonify/noise/noise_chain.hpp"
#include "ensonify/noise/ping_setting.hpp"

namespace ensonify {

/// An echo as the receiver has it, before TVG: rows = range bins, columns = beams, units of `Echo`.
struct ReceivedEcho {
  Image2<float> power;  ///< of this ping, speckle and receiver noise in it
  Echo layers;          ///< mean powers before the point spread, as the stages on the echo left them
  /// Mean power of the multipath through main lobes; empty without a multipath stage.
  Image2<float> multipath;
  /// Mean power through sidelobes, arcs and cross-talk; empty where the chain models none.
  Image2<float> sidelobe;
};

/// Runs the stages of a chain that act before the image. Coherent speckle: the layers are summed as complex amplitudes,
/// then go once through pulse and array. Incoherent: their intensities go through the point spread first.
ReceivedEcho disturb_echo(const NoiseChain& chain, const Echo& echo, const Receiver& receiver,
                          const PingSetting& setting);

}  // namespace ensonify
