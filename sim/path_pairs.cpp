#include "ensonify/sim/path_pairs.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>

#include "ensonify/core/lanes.hpp"
#include "ensonify/sim/path_pair.hpp"

namespace ensonify {
namespace {

constexpr int pairs = joined_points * packet_lanes;

/// 2^32 over the golden ratio: multiples are spread evenly (Knuth 1998, 6.4).
constexpr std::uint32_t golden = 2654435769u;

/// Points of one tile against a packet each of one block.
struct Group {
  float energy[pairs];
  float half_length_m[pairs];
  float extent_m[pairs];
  const PathPoints* from[joined_points];  ///< the tile's points, in `lane`
  const PathPoints* to[joined_points];
  int lane;
  bool both_ends;
};

static_assert(packet_lanes == lane_count);

/// Whether any of a packet and a place face each other: three quarters do not, so this is asked most. In vectors by
/// hand: left to itself, the compiler unrolls so short a loop before it looks for vectors.
bool any_facing(const PathPoints& a, const PathPoints& b, int j) {
  const Lanes x = lanes_of(a.x) - b.x[j];
  const Lanes y = lanes_of(a.y) - b.y[j];
  const Lanes z = lanes_of(a.z) - b.z[j];
  const Lanes at_b = b.nx[j] * x + b.ny[j] * y + b.nz[j] * z;
  const Lanes at_a = lanes_of(a.nx) * x + lanes_of(a.ny) * y + lanes_of(a.nz) * z;
  const auto facing = (at_b > 0.0f) & (at_a < 0.0f);
  std::array<std::uint64_t, packet_lanes / 2> words;
  static_assert(sizeof(words) == sizeof(facing));
  std::memcpy(&words, &facing, sizeof(words));
  return (words[0] | words[1] | words[2] | words[3]) != 0;
}

/// Adds up the energy; 0 where nothing faces.
float evaluate(Group& group) {
  float sum = 0.0f;
  for (int q = 0; q < joined_points; ++q) {
    const PathPoints& a = *group.to[q];
    const PathPoints& b = *group.from[q];
    float* energy = group.energy + q * packet_lanes;
    float* half_length = group.half_length_m + q * packet_lanes;
    float* extent = group.extent_m + q * packet_lanes;
    if (!any_facing(a, b, group.lane)) {
      std::fill(energy, energy + packet_lanes, 0.0f);
      continue;
    }
    for (int l = 0; l < packet_lanes; ++l) {
      const PathPair pair = path_pair(a, l, b, group.lane);
      energy[l] = pair.energy;
      half_length[l] = pair.half_length_m;
      extent[l] = pair.extent_m;
    }
    for (int l = 0; l < packet_lanes; ++l) sum += energy[l];
  }
  return sum;
}

int pick(const Group& group, float sum, float u) {
  float left = u * sum;
  int last = 0;
  for (int k = 0; k < pairs; ++k) {
    if (group.energy[k] <= 0.0f) continue;
    last = k;
    left -= group.energy[k];
    if (left < 0.0f) break;
  }
  return last;
}

/// Whether any of the paths ends within the window: what lies beyond is lost, seen or not.
bool reaches_window(const Group& group, const PathImage& image) {
  for (int k = 0; k < pairs; ++k) {
    if (group.energy[k] > 0.0f && image.may_hold(group.half_length_m[k], group.extent_m[k])) return true;
  }
  return false;
}

/// Eight boxes, computed side by side.
struct alignas(32) Boxes {
  int near_bin[packet_lanes], far_bin[packet_lanes];
  float density[packet_lanes], near_next[packet_lanes], far_next[packet_lanes];

  Boxes(const Group& group, int q, const float* nearest_m, const PathImage& image) {
    for (int l = 0; l < packet_lanes; ++l) {
      const int k = q * packet_lanes + l;
      const PathBox box = image.box(group.half_length_m[k], group.extent_m[k], nearest_m[l], group.energy[k]);
      near_bin[l] = box.near_bin, far_bin[l] = box.far_bin;
      density[l] = box.density, near_next[l] = box.near_next, far_next[l] = box.far_next;
    }
  }
  PathBox operator[](int l) const { return {near_bin[l], far_bin[l], density[l], near_next[l], far_next[l]}; }
};

void add(const Group& group, PathImage& image) {
  for (int q = 0; q < joined_points; ++q) {
    const float* energy = group.energy + q * packet_lanes;
    if (*std::max_element(energy, energy + packet_lanes) <= 0.0f) continue;
    const PathPoints& a = *group.to[q];
    const PathPoints& b = *group.from[q];
    float nearest_m[packet_lanes];
    std::fill(nearest_m, nearest_m + packet_lanes, b.range_m[group.lane]);
    const Boxes at_b(group, q, nearest_m, image);
    for (int l = 0; l < packet_lanes; ++l) {
      if (energy[l] > 0.0f) image.add(b.column[group.lane], at_b[l]);
    }
    if (!group.both_ends) continue;
    const Boxes at_a(group, q, a.range_m, image);
    for (int l = 0; l < packet_lanes; ++l) {
      if (energy[l] > 0.0f) image.add(a.column[l], at_a[l]);
    }
  }
}

float unit_of(std::uint32_t word) { return static_cast<float>(word >> 8) * 0x1p-24f; }

}  // namespace

void add_joined_pairs(const PathView& view, const PathHits& hits, PathImage& image) {
  std::array<Group, packet_lanes> groups;
  RayPacket rays;
  int waiting = 0;
  std::uint32_t asked = 0;
  const auto ask = [&] {
    for (int l = 0; l < packet_lanes; ++l) rays.valid[l] = l < waiting;
    const auto blocked = rays.occluded(view.scene);
    for (int l = 0; l < waiting; ++l) {
      if (!blocked[l]) add(groups[l], image);
    }
    waiting = 0;
  };
  for (int one = 0; one < hits.blocks; ++one) {
    for (int other = one; other < hits.blocks; ++other) {
      // Which of two tiles' points meet: never a point itself.
      const std::uint32_t word = golden * static_cast<std::uint32_t>(one * hits.blocks + other) >> 8;
      const int shift = 1 + static_cast<int>(word % 7);
      for (int tile = 0; tile < packet_lanes; ++tile) {
        Group& group = groups[waiting];
        group.lane = tile;
        group.both_ends = other != one;
        for (int q = 0; q < joined_points; ++q) {
          const int point = (PathTiles::points / joined_points) * q + (static_cast<int>(word >> 12) + tile) % 2;
          group.from[q] = &hits.of(one, point);
          group.to[q] = &hits.of(other, point ^ shift);
        }
        const float sum = evaluate(group);
        if (!(sum > 0.0f) || !reaches_window(group, image)) continue;
        const int k = pick(group, sum, unit_of(golden * ++asked));
        const Eigen::Vector3f start = lifted(*group.from[k / packet_lanes], tile, view.axes);
        rays.origin[waiting] = start;
        rays.direction[waiting] = lifted(*group.to[k / packet_lanes], k % packet_lanes, view.axes) - start;
        if (++waiting == packet_lanes) ask();
      }
    }
  }
  ask();
}

}  // namespace ensonify
