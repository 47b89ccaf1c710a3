#pragma once

namespace ensonify {

/// Homogeneous water: straight rays, one sound speed, one absorption.
struct Water {
  double temperature_c = 10;
  double salinity_psu = 35;
  double depth_m = 5;  ///< depth the sound speed and absorption are taken at
  double ph = 8;
};

/// Sound speed (m/s): Mackenzie 1981 for S in 25..40, Medwin 1975 below (fresh and brackish).
double sound_speed_mps(const Water& water);

/// Mackenzie 1981, 9 terms; T 2..30 C, S 25..40, D 0..8000 m.
double sound_speed_mackenzie_mps(double temperature_c, double salinity_psu, double depth_m);
/// Medwin 1975; T 0..35 C, S 0..45, z 0..1000 m.
double sound_speed_medwin_mps(double temperature_c, double salinity_psu, double depth_m);

/// Absorption (dB/m, one way): Francois and Garrison 1982; boric acid and magnesium sulphate vanish at S = 0.
double absorption_db_per_m(const Water& water, double frequency_hz);

}  // namespace ensonify
