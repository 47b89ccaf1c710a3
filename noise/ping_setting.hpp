#pragma once

#include "ensonify/core/pose.hpp"
#include "ensonify/core/random.hpp"
#include "ensonify/sensor_models/coherent_spread.hpp"
#include "ensonify/sensor_models/point_spread.hpp"
#include "ensonify/sensor_models/sonar_model.hpp"

namespace ensonify {

/// An instrument and how it smears an echo.
struct Receiver {
  explicit Receiver(const SonarModel& model) : sonar(model), spread(model), coherent(model) {}

  SonarModel sonar;
  PointSpread spread;
  CoherentSpread coherent;
};

/// What the noise of a ping depends on beside its echo.
struct PingSetting {
  Pose T_world_sonar = Pose::Identity();
  RandomKey surface{};             ///< of the place: scatterers stay where they are from ping to ping
  RandomKey device{};              ///< of the instrument: what it does in every ping
  RandomKey ping{};                ///< of this ping
  double absorption_db_per_m = 0;  ///< of the water, one way
};

}  // namespace ensonify
