#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "ensonify/core/pose.hpp"
#include "ensonify/core/random.hpp"
#include "ensonify/sensor_models/sonar_model.hpp"

namespace ensonify {

/// Random numbers that belong to pieces of the surface and not to pixels: the piece that a pixel sees is found from
/// range, bearing and mean elevation of its echo, and named by where it lies in the world. So a sonar that comes back
/// sees the same numbers, and one that moves sees them change as pieces leave its cells.
class SurfaceCells {
 public:
  SurfaceCells(const SonarModel& sonar, const Pose& T_world_sonar);

  /// Uniform numbers of the resolution cells of a row, two each. A piece is a slice, one range bin thick along the line
  /// of sight, of a cube as wide as the beams are apart at that range (in steps of an eighth of an octave, so that the
  /// same cubes serve some ranges). A move sideways of that width, or of a bin in range, gives a new piece.
  /// For the beams from `first` on, as many as uniform0 is long. `elevation_rad`: of each of them, or empty for the
  /// horizontal plane of the sonar.
  void resolution_cells(RandomKey key, int bin, std::size_t first, std::span<const float> elevation_rad,
                        std::span<float> uniform0, std::span<float> uniform1);

  /// Uniform numbers of the cubes of `patch_m` that these beams see.
  void patches(RandomKey key, int bin, std::size_t first, std::span<const float> elevation_rad, float patch_m,
               std::span<float> uniform);

 private:
  void look_up(RandomKey key, std::span<float> uniform0, std::span<float> uniform1);
  void name_cubes(std::size_t first, std::size_t count, float range_m, std::span<const float> elevation_rad,
                  float cube_m, float slice_m);

  RandomKey key_of_size(RandomKey key, int size);

  SonarGeometry geometry_;
  std::vector<int> cube_size_;  ///< a bin: in eighths of an octave over a metre
  Eigen::Vector3f origin_, up_;
  float beam_spacing_;  ///< sines
  struct KeyOfSize {
    RandomKey of;
    int size;
    RandomKey key;
  };
  std::optional<KeyOfSize> last_key_;               ///< the same for many cells of a row, and for many rows
  std::vector<float> ahead_x_, ahead_y_, ahead_z_;  ///< a beam: its horizontal direction, in the world
  std::vector<std::uint32_t> c0_, c1_, c2_, c3_, word0_, word1_;
};

}  // namespace ensonify
