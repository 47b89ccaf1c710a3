#pragma once

#include "ensonify/core/complex_field.hpp"
#include "ensonify/noise/noise_chain.hpp"
#include "ensonify/noise/ping_setting.hpp"

namespace ensonify {

/// Adds what is random before the array: receiver noise and volume reverberation. True where the chain has any.
bool add_white_sources(const NoiseChain& chain, const Receiver& receiver, const PingSetting& setting,
                       ComplexField& field);

/// Runs the stages that act on the received field: ring-down, sidelobe arcs, cross-talk, interference.
void disturb_field(const NoiseChain& chain, const Receiver& receiver, const PingSetting& setting, ComplexField& field);

/// Mean power that sidelobe arcs and cross-talk add to each pixel of an echo of mean power `power` (before the point
/// spread); added to `leaked`.
void add_leaked_power(const NoiseChain& chain, const Receiver& receiver, const Image2<float>& power,
                      Image2<float>& leaked);

}  // namespace ensonify
