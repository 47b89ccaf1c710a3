#include "ensonify/sim/voxel_parity.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "ensonify/core/parallel.hpp"

namespace ensonify {
namespace {

/// First index whose cell centre is at or above `x`, within [0, end].
int first_centre_from(double x, int end) {
  return static_cast<int>(std::ceil(std::clamp(x - 0.5, 0.0, static_cast<double>(end))));
}

/// Where edge low-high cuts the row at v. Called with the lower end first, so that both triangles of an edge agree.
double cut(const Vec3& low, const Vec3& high, int u, int v, double row) {
  return low[u] + (row - low[v]) * ((high[u] - low[u]) / (high[v] - low[v]));
}

/// Flips, in every column along w whose centre line passes the triangle, the first cell beyond it.
template <int w>
void flip_beyond(std::array<Vec3, 3> corner, BitGrid& crossings) {
  constexpr int u = w == 0 ? 1 : 0;  // u = x where possible: neighbours in a word
  constexpr int v = w == 2 ? 1 : 2;
  for (Vec3& c : corner) c -= Vec3(crossings.low[0], crossings.low[1], crossings.low[2]);
  if (corner[0][v] > corner[1][v]) std::swap(corner[0], corner[1]);
  if (corner[1][v] > corner[2][v]) std::swap(corner[1], corner[2]);
  if (corner[0][v] > corner[1][v]) std::swap(corner[0], corner[1]);

  const auto& size = crossings.size;
  const int row_begin = first_centre_from(corner[0][v], size[v]);
  const int row_end = first_centre_from(corner[2][v], size[v]);
  if (row_begin == row_end) return;

  const Vec3 n = (corner[1] - corner[0]).cross(corner[2] - corner[0]);
  const double inverse = n[w] != 0 ? 1.0 / n[w] : 0.0;
  const auto [w_low, w_high] = std::minmax({corner[0][w], corner[1][w], corner[2][w]});

  for (int iv = row_begin; iv < row_end; ++iv) {
    const double row = iv + 0.5;
    const double long_edge = cut(corner[0], corner[2], u, v, row);
    const double short_edge =
        row < corner[1][v] ? cut(corner[0], corner[1], u, v, row) : cut(corner[1], corner[2], u, v, row);
    const int begin = first_centre_from(std::min(long_edge, short_edge), size[u]);
    const int end = first_centre_from(std::max(long_edge, short_edge), size[u]);
    for (int iu = begin; iu < end; ++iu) {
      // A steep triangle's plane is badly known but its extent is not.
      const double plane = corner[0][w] - inverse * (n[u] * (iu + 0.5 - corner[0][u]) + n[v] * (row - corner[0][v]));
      const int iw = first_centre_from(std::clamp(plane, w_low, w_high), size[w]);
      if (iw == size[w]) continue;
      std::array<int, 3> c{};
      c[u] = iu;
      c[v] = iv;
      c[w] = iw;
      crossings.flip(c[0], c[1], c[2]);
    }
  }
}

/// Running parity along each row: bit i becomes the xor of bits 0..i.
void accumulate_x(std::uint64_t* row, int words) {
  bool carry = false;
  for (int i = 0; i < words; ++i) {
    std::uint64_t word = row[i];
    for (int shift = 1; shift < 64; shift *= 2) word ^= word << shift;
    if (carry) word = ~word;
    carry = word >> 63;
    row[i] = word;
  }
}

}  // namespace

ParityVote vote_parity(std::span<const Vec3> vertices_cells, std::span<const std::array<std::uint32_t, 3>> triangles,
                       const std::array<int, 3>& low, const std::array<int, 3>& size) {
  BitGrid along_x(low, size);
  BitGrid along_y(low, size);
  BitGrid along_z(low, size);
  parallel_for(static_cast<int>(triangles.size()), [&](int i) {
    const auto& t = triangles[i];
    const std::array<Vec3, 3> corner = {vertices_cells[t[0]], vertices_cells[t[1]], vertices_cells[t[2]]};
    flip_beyond<0>(corner, along_x);
    flip_beyond<1>(corner, along_y);
    flip_beyond<2>(corner, along_z);
  });

  parallel_for(size[1], [&](int y) {
    for (int z = 1; z < size[2]; ++z) {
      for (int i = 0; i < along_z.row_words; ++i) along_z.row(y, z)[i] ^= along_z.row(y, z - 1)[i];
    }
  });
  ParityVote vote{std::move(along_x), std::move(along_y)};
  parallel_for(size[2], [&](int z) {
    for (int y = 0; y < size[1]; ++y) {
      std::uint64_t* x = vote.inside.row(y, z);
      std::uint64_t* d = vote.disagreement.row(y, z);
      const int words = vote.inside.row_words;
      accumulate_x(x, words);
      if (y > 0) {
        for (int i = 0; i < words; ++i) d[i] ^= vote.disagreement.row(y - 1, z)[i];
      }
    }
    for (int y = 0; y < size[1]; ++y) {
      std::uint64_t* x_votes = vote.inside.row(y, z);
      std::uint64_t* y_votes = vote.disagreement.row(y, z);
      const std::uint64_t* z_votes = along_z.row(y, z);
      const int words = vote.inside.row_words;
      for (int i = 0; i < words; ++i) {
        const std::uint64_t a = x_votes[i];
        const std::uint64_t b = y_votes[i];
        const std::uint64_t c = z_votes[i];
        x_votes[i] = (a & b) | (b & c) | (a & c);
        y_votes[i] = (a ^ b) | (b ^ c);
      }
      // Bits past the end of a row belong to no cell.
      if (const int used = vote.inside.size[0] & 63) {
        const std::uint64_t mask = (std::uint64_t{1} << used) - 1;
        x_votes[words - 1] &= mask;
        y_votes[words - 1] &= mask;
      }
    }
  });
  return vote;
}

}  // namespace ensonify
