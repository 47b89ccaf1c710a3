#pragma once

#include <cmath>

#include "ensonify/sim/bistatic.hpp"
#include "ensonify/sim/path_points.hpp"

namespace ensonify {

/// Of a tile's points, those that are joined to a point each of another tile.
inline constexpr int joined_points = 4;
/// Hence pairs joined over pairs there are.
inline constexpr float joined_share = 1.0f * joined_points / (PathTiles::points * PathTiles::points);
inline constexpr int walks_per_point = 2;

/// What one pair of places adds at the bearing of either, whichever technique found it.
struct PathPair {
  float energy;
  float half_length_m;  ///< of the whole path
  float extent_m;       ///< of half lengths that the pair stands for
};

/// The path sonar - A - B - sonar carries, of cells dOmega_A and dOmega_B of the fan,
///   g_A g_B  sigma_A(sonar, B) / cos_A  sigma_B(A, sonar) / cos_B  d^-2  dOmega_A dOmega_B
/// (spherical spreading to A and from B cancels against dA = r^2 dOmega / cos; g: one-way patterns; absorption is left
/// to the end). Symmetric in A and B. Pairs are found in two ways: points of the fan joined to points of the fan
/// (half of a tile's points with one each of every other tile), and `walks_per_point` walks that leave a point into a
/// direction that its surface prefers. Divided by the sum of both densities (balance heuristic, Veach and Guibas 1995,
/// eq. 14) every pair found counts the same, and the pole of d^-2 and the lobes of mirrors are gone: the walks' density
/// has them too. Without `joining`, walks alone are reckoned with.
inline PathPair path_pair(const PathPoints& a, int i, const PathPoints& b, int j, bool joining = true) {
  const float x = a.x[i] - b.x[j];
  const float y = a.y[i] - b.y[j];
  const float z = a.z[i] - b.z[j];
  const float d2 = x * x + y * y + z * z + 1e-12f;
  const float inverse_d = 1.0f / std::sqrt(d2);
  const float ex = x * inverse_d;
  const float ey = y * inverse_d;
  const float ez = z * inverse_d;
  const float cos_b = b.nx[j] * ex + b.ny[j] * ey + b.nz[j] * ez;
  const float cos_a = -(a.nx[i] * ex + a.ny[i] * ey + a.nz[i] * ez);
  const float along_b = b.dx[j] * ex + b.dy[j] * ey + b.dz[j] * ez;
  const float along_a = a.dx[i] * ex + a.dy[i] * ey + a.dz[i] * ez;
  const bool facing = cos_a > 1e-3f && cos_b > 1e-3f;
  const float facing_a = facing ? cos_a : 1.0f;
  const float facing_b = facing ? cos_b : 1.0f;
  const bistatic::Scattered at_a =
      bistatic::scatter({a.mu[i], a.specular[i], a.exponent[i], a.lobe_share[i]}, a.cos_sonar[i], facing_a, along_a);
  const bistatic::Scattered at_b =
      bistatic::scatter({b.mu[j], b.specular[j], b.exponent[j], b.lobe_share[j]}, b.cos_sonar[j], facing_b, -along_b);
  // d^2 times densities; the walk's solid angle is dA cos / d^2.
  const float to_a = walks_per_point * b.density[j] * at_b.pdf * a.area_m2[i] * facing_a;
  const float to_b = walks_per_point * a.density[i] * at_a.pdf * b.area_m2[j] * facing_b;
  const float join = (joining ? d2 * joined_share : 0.0f) * a.density[i] * b.density[j];
  const float share = 1.0f / (join + to_a + to_b);
  const float energy = a.send[i] * b.send[j] * at_a.sigma * at_b.sigma * share;

  const float au = (a.dx[i] + ex) * a.ux[i] + (a.dy[i] + ey) * a.uy[i] + (a.dz[i] + ez) * a.uz[i];
  const float av = (a.dx[i] + ex) * a.vx[i] + (a.dy[i] + ey) * a.vy[i] + (a.dz[i] + ez) * a.vz[i];
  const float bu = (b.dx[j] - ex) * b.ux[j] + (b.dy[j] - ey) * b.uy[j] + (b.dz[j] - ez) * b.uz[j];
  const float bv = (b.dx[j] - ex) * b.vx[j] + (b.dy[j] - ey) * b.vy[j] + (b.dz[j] - ez) * b.vz[j];
  const float extent = 0.5f * std::sqrt((au * au + av * av + bu * bu + bv * bv) * (join * share));
  return {facing ? energy : 0.0f, 0.5f * (a.range_m[i] + d2 * inverse_d + b.range_m[j]), extent};
}

}  // namespace ensonify
