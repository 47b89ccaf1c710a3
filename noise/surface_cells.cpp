#include "ensonify/noise/surface_cells.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "ensonify/noise/random_row.hpp"

namespace ensonify {
namespace {

/// Keeps whole numbers exact in single precision for a kilometre of world.
constexpr float least_cube_m = 1e-4f;

/// Cubes of somewhat less than the beams' distance: were they much smaller, pieces between two beams would be seen by
/// none; were they larger, neighbours would often see the same.
constexpr int sizes_an_octave = 8;

inline std::uint32_t whole(float x) { return static_cast<std::uint32_t>(static_cast<std::int32_t>(std::floor(x))); }

}  // namespace

SurfaceCells::SurfaceCells(const SonarModel& sonar, const Pose& T_world_sonar)
    : geometry_(sonar.geometry),
      origin_(T_world_sonar.translation().cast<float>()),
      up_(T_world_sonar.linear().col(2).cast<float>()) {
  const auto beams = static_cast<std::size_t>(geometry_.beams());
  const auto& azimuth = geometry_.beam_azimuth_rad;
  beam_spacing_ =
      beams > 1
          ? static_cast<float>((std::sin(azimuth.front()) - std::sin(azimuth.back())) / static_cast<double>(beams - 1))
          : static_cast<float>(sonar.receive_azimuth.width_rad());
  for (const double theta : azimuth) {
    const Vec3 ahead = T_world_sonar.linear() * Vec3(std::cos(theta), std::sin(theta), 0.0);
    ahead_x_.push_back(static_cast<float>(ahead.x()));
    ahead_y_.push_back(static_cast<float>(ahead.y()));
    ahead_z_.push_back(static_cast<float>(ahead.z()));
  }
  const auto slice_m = static_cast<float>(geometry_.bin_size_m());
  for (int bin = 0; bin < geometry_.range_bins; ++bin) {
    const auto range_m = static_cast<float>(geometry_.bin_centre_m(bin));
    const float apart_m = std::max({beam_spacing_ * range_m, 0.25f * slice_m, least_cube_m});
    cube_size_.push_back(static_cast<int>(std::lround(sizes_an_octave * std::log2(0.88f * apart_m))));
  }
  for (auto* v : {&c0_, &c1_, &c2_, &c3_, &word0_, &word1_}) v->resize(beams);
}

void SurfaceCells::name_cubes(std::size_t first, std::size_t count, float range_m, std::span<const float> elevation_rad,
                              float cube_m, float slice_m) {
  const float per_cube = 1.0f / cube_m;
  const float per_slice = 1.0f / slice_m;
  const float* __restrict ax = ahead_x_.data() + first;
  const float* __restrict ay = ahead_y_.data() + first;
  const float* __restrict az = ahead_z_.data() + first;
  std::uint32_t* __restrict c0 = c0_.data();
  std::uint32_t* __restrict c1 = c1_.data();
  std::uint32_t* __restrict c2 = c2_.data();
  std::uint32_t* __restrict c3 = c3_.data();
  const auto name = [&](std::size_t b, float phi) {
    // Taylor series, exact to 2e-7 up to 30 deg, to 4e-5 up to 60 deg (the edge of the widest field of view), to 1e-3
    // at 90 deg. A name needs no more: it lies off by that share of the range, alike in pings from the same elevation.
    const float square = phi * phi;
    const float cosine = 1.0f - square * (0.5f - square * (1.0f / 24.0f - square * (1.0f / 720.0f)));
    const float sine = phi * (1.0f - square * (1.0f / 6.0f - square * (1.0f / 120.0f - square * (1.0f / 5040.0f))));
    const float dx = cosine * ax[b] + sine * up_.x();
    const float dy = cosine * ay[b] + sine * up_.y();
    const float dz = cosine * az[b] + sine * up_.z();
    const float x = (origin_.x() + range_m * dx) * per_cube;
    const float y = (origin_.y() + range_m * dy) * per_cube;
    const float z = (origin_.z() + range_m * dz) * per_cube;
    // From the cube's own middle: seen from there, the slices hardly move when the sonar turns.
    const float along =
        (x - std::floor(x) - 0.5f) * dx + (y - std::floor(y) - 0.5f) * dy + (z - std::floor(z) - 0.5f) * dz;
    c0[b] = whole(x);
    c1[b] = whole(y);
    c2[b] = whole(z);
    c3[b] = whole(along * cube_m * per_slice);
  };
  if (elevation_rad.empty()) {
    for (std::size_t b = 0; b < count; ++b) name(b, 0.0f);
  } else {
    const float* __restrict phi = elevation_rad.data();
    for (std::size_t b = 0; b < count; ++b) name(b, phi[b]);
  }
}

void SurfaceCells::look_up(RandomKey key, std::span<float> uniform0, std::span<float> uniform1) {
  const auto used = [&](std::vector<std::uint32_t>& words) { return std::span(words).first(uniform0.size()); };
  words_at(key, {used(c0_), used(c1_), used(c2_), used(c3_)}, used(word0_), used(word1_));
  for (std::size_t b = 0; b < uniform0.size(); ++b) uniform0[b] = uniform_of(word0_[b]);
  for (std::size_t b = 0; b < uniform1.size(); ++b) uniform1[b] = uniform_of(word1_[b]);
}

RandomKey SurfaceCells::key_of_size(RandomKey key, int size) {
  if (!last_key_ || last_key_->of != key || last_key_->size != size) {
    last_key_ = KeyOfSize{key, size, key.child(static_cast<std::uint64_t>(size + 1024))};
  }
  return last_key_->key;
}

void SurfaceCells::resolution_cells(RandomKey key, int bin, std::size_t first, std::span<const float> elevation_rad,
                                    std::span<float> uniform0, std::span<float> uniform1) {
  const auto range_m = static_cast<float>(geometry_.bin_centre_m(bin));
  const auto slice_m = static_cast<float>(geometry_.bin_size_m());
  const int size = cube_size_[static_cast<std::size_t>(bin)];
  name_cubes(first, uniform0.size(), range_m, elevation_rad, std::exp2(static_cast<float>(size) / sizes_an_octave),
             slice_m);
  look_up(key_of_size(key, size), uniform0, uniform1);
}

void SurfaceCells::patches(RandomKey key, int bin, std::size_t first, std::span<const float> elevation_rad,
                           float patch_m, std::span<float> uniform) {
  const float cube_m = std::max(patch_m, least_cube_m);
  name_cubes(first, uniform.size(), static_cast<float>(geometry_.bin_centre_m(bin)), elevation_rad, cube_m,
             std::numeric_limits<float>::infinity());  // whole cubes
  look_up(key, uniform, {});
}

}  // namespace ensonify
