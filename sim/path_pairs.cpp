#include "ensonify/sim/path_pairs.hpp"

#include <array>

#include "ensonify/sim/path_pair.hpp"

namespace ensonify {
namespace {

constexpr int tile_points = PathFan::tile_columns;
constexpr int pairs = tile_points * packet_lanes;

/// All points of one tile against a packet each of one block.
struct Group {
  float energy[pairs];
  float half_length_m[pairs];
  float extent_m[pairs];
  const PathPoints* from[tile_points];  ///< the tile's points, in `lane`
  const PathPoints* to[tile_points];
  int lane;
  bool both_ends;
};

/// Adds up the energy; 0 where nothing faces.
float evaluate(Group& group) {
  float sum = 0.0f;
  for (int q = 0; q < tile_points; ++q) {
    const PathPoints& a = *group.to[q];
    const PathPoints& b = *group.from[q];
    float* energy = group.energy + q * packet_lanes;
    float* half_length = group.half_length_m + q * packet_lanes;
    float* extent = group.extent_m + q * packet_lanes;
    for (int l = 0; l < packet_lanes; ++l) {
      const PathPair pair = path_pair(a, l, b, group.lane, joined_share);
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

void add(const Group& group, PathImage& image) {
  for (int k = 0; k < pairs; ++k) {
    if (group.energy[k] <= 0.0f) continue;
    const PathPoints& a = *group.to[k / packet_lanes];
    const PathPoints& b = *group.from[k / packet_lanes];
    const int l = k % packet_lanes;
    const float half_length = group.half_length_m[k];
    const float extent = group.extent_m[k];
    image.add(b.column[group.lane], half_length, extent, b.range_m[group.lane], group.energy[k]);
    if (group.both_ends) image.add(a.column[l], half_length, extent, a.range_m[l], group.energy[k]);
  }
}

}  // namespace

void add_joined_pairs(const RayScene& scene, const PathHits& hits, const RayAxes& axes, PathImage& image) {
  std::array<Group, packet_lanes> groups;
  RayPacket rays;
  int waiting = 0;
  std::uint32_t asked = 0;
  const auto ask = [&] {
    for (int l = 0; l < packet_lanes; ++l) rays.valid[l] = l < waiting;
    const auto blocked = rays.occluded(scene);
    for (int l = 0; l < waiting; ++l) {
      if (!blocked[l]) add(groups[l], image);
    }
    waiting = 0;
  };
  for (int one = 0; one < hits.block_count; ++one) {
    for (int other = one; other < hits.block_count; ++other) {
      // Which of a tile's points meet: never a point itself, and the same both ways.
      const int shift = 1 + static_cast<int>((static_cast<std::uint32_t>(one * hits.block_count + other) * 2654435769u >> 8) % 7);
      for (int tile = 0; tile < packet_lanes; ++tile) {
        Group& group = groups[waiting];
        group.lane = tile;
        group.both_ends = other != one;
        for (int q = 0; q < tile_points; ++q) {
          group.from[q] = &hits.of(q, one);
          group.to[q] = &hits.of(q ^ shift, other);
        }
        const float sum = evaluate(group);
        if (!(sum > 0.0f)) continue;
        const float u = static_cast<float>((++asked * 2654435769u) >> 8) * 0x1p-24f;
        const int k = pick(group, sum, u);
        rays.origin[waiting] = lifted(*group.from[k / packet_lanes], tile, axes);
        rays.direction[waiting] = lifted(*group.to[k / packet_lanes], k % packet_lanes, axes) - rays.origin[waiting];
        if (++waiting == packet_lanes) ask();
      }
    }
  }
  ask();
}

}  // namespace ensonify
