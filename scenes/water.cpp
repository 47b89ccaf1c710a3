#include "ensonify/scenes/water.hpp"

#include <cmath>

namespace ensonify {

double sound_speed_mackenzie_mps(double temperature_c, double salinity_psu, double depth_m) {
  const double t = temperature_c;
  const double s = salinity_psu - 35.0;
  const double d = depth_m;
  return 1448.96 + 4.591 * t - 5.304e-2 * t * t + 2.374e-4 * t * t * t + 1.340 * s + 1.630e-2 * d + 1.675e-7 * d * d -
         1.025e-2 * t * s - 7.139e-13 * t * d * d * d;
}

double sound_speed_medwin_mps(double temperature_c, double salinity_psu, double depth_m) {
  const double t = temperature_c;
  return 1449.2 + 4.6 * t - 0.055 * t * t + 0.00029 * t * t * t + (1.34 - 0.010 * t) * (salinity_psu - 35.0) +
         0.016 * depth_m;
}

double sound_speed_mps(const Water& water) {
  constexpr double mackenzie_salinity_min_psu = 25;
  return water.salinity_psu >= mackenzie_salinity_min_psu
             ? sound_speed_mackenzie_mps(water.temperature_c, water.salinity_psu, water.depth_m)
             : sound_speed_medwin_mps(water.temperature_c, water.salinity_psu, water.depth_m);
}

double absorption_db_per_m(const Water& water, double frequency_hz) {
  const double f = frequency_hz / 1000.0;
  const double t = water.temperature_c;
  const double s = water.salinity_psu;
  const double d = water.depth_m;
  const double c = 1412.0 + 3.21 * t + 1.19 * s + 0.0167 * d;

  double boric = 0;
  double magnesium = 0;
  if (s > 0) {
    const double a1 = 8.86 / c * std::pow(10.0, 0.78 * water.ph - 5.0);
    const double f1 = 2.8 * std::sqrt(s / 35.0) * std::pow(10.0, 4.0 - 1245.0 / (t + 273.0));
    boric = a1 * f1 * f * f / (f1 * f1 + f * f);

    const double a2 = 21.44 * s / c * (1.0 + 0.025 * t);
    const double f2 = 8.17 * std::pow(10.0, 8.0 - 1990.0 / (t + 273.0)) / (1.0 + 0.0018 * (s - 35.0));
    const double p2 = 1.0 - 1.37e-4 * d + 6.2e-9 * d * d;
    magnesium = a2 * p2 * f2 * f * f / (f2 * f2 + f * f);
  }
  const double a3 = t <= 20.0 ? 4.937e-4 - 2.59e-5 * t + 9.11e-7 * t * t - 1.50e-8 * t * t * t
                              : 3.964e-4 - 1.146e-5 * t + 1.45e-7 * t * t - 6.5e-10 * t * t * t;
  const double p3 = 1.0 - 3.83e-5 * d + 4.9e-10 * d * d;
  const double pure_water = a3 * p3 * f * f;

  return (boric + magnesium + pure_water) / 1000.0;
}

}  // namespace ensonify
