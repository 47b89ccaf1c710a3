#include "ensonify/sim/mesh_edges.hpp"

#include <algorithm>
#include <bit>
#include <cstdint>
#include <utility>
#include <vector>

namespace ensonify {
namespace {

std::uint64_t mix(const Eigen::Vector3f& p) {
  std::uint64_t hash = 0;
  for (int a = 0; a < 3; ++a) {
    hash = (hash ^ std::bit_cast<std::uint32_t>(p[a] + 0.0F)) * 0x9E3779B97F4A7C15U;  // + 0: -0 is 0
    hash ^= hash >> 29;
  }
  return hash;
}

/// For each vertex the first vertex at the same position (open addressing, linear probing).
std::vector<std::uint32_t> first_at_same_place(const std::vector<Eigen::Vector3f>& vertices) {
  constexpr std::uint32_t none = 0xFFFFFFFF;
  const std::size_t slots = std::bit_ceil(vertices.size() * 2 + 1);
  std::vector<std::uint32_t> table(slots, none);
  std::vector<std::uint32_t> first(vertices.size());
  for (std::uint32_t i = 0; i < vertices.size(); ++i) {
    std::size_t slot = mix(vertices[i]) & (slots - 1);
    while (table[slot] != none && vertices[table[slot]] != vertices[i]) slot = (slot + 1) & (slots - 1);
    if (table[slot] == none) table[slot] = i;
    first[i] = table[slot];
  }
  return first;
}

}  // namespace

EdgeCount count_edges(const TriangleMesh& mesh) {
  const std::vector<std::uint32_t> vertex = first_at_same_place(mesh.vertices_m);
  const auto for_each_edge = [&](auto&& visit) {
    for (const auto& t : mesh.triangles) {
      for (int i = 0; i < 3; ++i) {
        const std::uint32_t from = vertex[t[i]], to = vertex[t[(i + 1) % 3]];
        if (from != to) visit(std::min(from, to), std::uint64_t{std::max(from, to)} << 1 | (from < to ? 1 : 0));
      }
    }
  };

  // Buckets by the lower end, filled in two passes: no sort over all edges. In them the higher end and the direction.
  std::vector<std::size_t> end(mesh.vertices_m.size() + 1, 0);
  for_each_edge([&](std::uint32_t low, std::uint64_t) { ++end[low]; });
  std::size_t total = 0;
  for (std::size_t& e : end) total = std::exchange(e, total) + total;
  std::vector<std::uint64_t> other_end(total);
  for_each_edge([&](std::uint32_t low, std::uint64_t high) { other_end[end[low]++] = high; });

  EdgeCount count;
  std::size_t begin = 0;
  for (std::size_t v = 0; v + 1 < end.size(); ++v) {
    const auto bucket_begin = other_end.begin() + static_cast<std::ptrdiff_t>(begin);
    const auto bucket_end = other_end.begin() + static_cast<std::ptrdiff_t>(end[v]);
    std::sort(bucket_begin, bucket_end);
    for (auto run = bucket_begin; run != bucket_end;) {
      const auto next = std::find_if(run, bucket_end, [&](std::uint64_t h) { return h >> 1 != *run >> 1; });
      const auto uses = next - run;
      count.open += uses == 1;
      count.nonmanifold += uses > 2;
      count.odd += uses % 2;
      count.unlike += uses == 2 && run[0] == run[1];
      run = next;
    }
    begin = end[v];
  }
  return count;
}

}  // namespace ensonify
