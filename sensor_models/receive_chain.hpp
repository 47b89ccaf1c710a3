#pragma once

#include "ensonify/core/echo.hpp"
#include "ensonify/sensor_models/sonar_model.hpp"

namespace ensonify {

/// Gain of the receive chain at a range, in dB re full scale. It rises with range. Single precision holds +-380 dB:
/// beyond `max_gain_db` too little is left for the echo itself and for a recipe's gain_db, and loading refuses.
constexpr double max_gain_db = 300;
double gain_db(const SonarModel& sonar, double range_m);

/// Linear power gain (TVG, source level, full scale) of every range bin: echo * gain = (amplitude over full scale)^2.
std::vector<float> row_gains(const SonarModel& sonar);

/// Echo intensity after the point spread -> pixel level in 0..1 after gamma (see `ReceiveChain`); rows = bins,
/// columns = beams.
Image2<float> receive(const SonarModel& sonar, const Image2<float>& intensity);

/// Level 0..1 -> 8-bit grey, rounded to nearest, clipped.
Image2<std::uint8_t> quantise(const Image2<float>& level);
/// Level 0..1 -> 16-bit grey, rounded to nearest, clipped.
Image2<std::uint16_t> quantise16(const Image2<float>& level);

}  // namespace ensonify
