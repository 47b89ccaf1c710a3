#include "ensonify/scenes/polygon.hpp"

#include <algorithm>
#include <numeric>

namespace ensonify {
namespace {

using Point = Eigen::Vector2d;

/// Twice the signed area of a triangle.
double turn(const Point& a, const Point& b, const Point& c) {
  const Point ab = b - a, ac = c - a;
  return ab.x() * ac.y() - ab.y() * ac.x();
}

bool in_box(const Point& p, const Point& a, const Point& b) {
  return (p.array() >= a.cwiseMin(b).array()).all() && (p.array() <= a.cwiseMax(b).array()).all();
}

bool segments_meet(const Point& a, const Point& b, const Point& c, const Point& d) {
  const double abc = turn(a, b, c), abd = turn(a, b, d), cda = turn(c, d, a), cdb = turn(c, d, b);
  if (((abc > 0 && abd < 0) || (abc < 0 && abd > 0)) && ((cda > 0 && cdb < 0) || (cda < 0 && cdb > 0))) return true;
  return (abc == 0 && in_box(c, a, b)) || (abd == 0 && in_box(d, a, b)) || (cda == 0 && in_box(a, c, d)) ||
         (cdb == 0 && in_box(b, c, d));
}

bool in_triangle(const Point& p, const Point& a, const Point& b, const Point& c) {
  return turn(a, b, p) >= 0 && turn(b, c, p) >= 0 && turn(c, a, p) >= 0;
}

/// Of all ears the one with the largest least angle would be finest; the largest area relative to its edges is as good
/// for echoes and needs no angles.
double ear_quality(const Point& a, const Point& b, const Point& c) {
  return turn(a, b, c) / ((b - a).squaredNorm() + (c - b).squaredNorm() + (a - c).squaredNorm());
}

}  // namespace

double signed_area(const Polygon& polygon) {
  double twice = 0;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Point &a = polygon[i], &b = polygon[(i + 1) % polygon.size()];
    twice += a.x() * b.y() - a.y() * b.x();
  }
  return 0.5 * twice;
}

bool is_simple(const Polygon& polygon) {
  const std::size_t n = polygon.size();
  if (n < 3) return false;
  for (std::size_t i = 0; i < n; ++i) {
    const Point &a = polygon[i], &b = polygon[(i + 1) % n], &c = polygon[(i + 2) % n];
    if (a == b) return false;
    if (turn(a, b, c) == 0 && (c - b).dot(b - a) < 0) return false;  // doubles back
    for (std::size_t j = i + 2; j < n; ++j) {
      if ((j + 1) % n != i && segments_meet(a, b, polygon[j], polygon[(j + 1) % n])) return false;
    }
  }
  return signed_area(polygon) != 0;
}

std::vector<std::array<std::uint32_t, 3>> triangulate(const Polygon& polygon) {
  std::vector<std::uint32_t> left(polygon.size());
  std::iota(left.begin(), left.end(), 0u);
  std::vector<std::array<std::uint32_t, 3>> triangles;
  while (left.size() > 3) {
    std::size_t best = 0;
    double best_quality = 0;
    for (std::size_t i = 0; i < left.size(); ++i) {
      const std::uint32_t a = left[(i + left.size() - 1) % left.size()], b = left[i], c = left[(i + 1) % left.size()];
      const double quality = ear_quality(polygon[a], polygon[b], polygon[c]);
      if (quality <= best_quality) continue;
      const bool empty = std::none_of(left.begin(), left.end(), [&](std::uint32_t p) {
        return p != a && p != b && p != c && in_triangle(polygon[p], polygon[a], polygon[b], polygon[c]);
      });
      if (!empty) continue;
      best = i;
      best_quality = quality;
    }
    const std::size_t n = left.size();
    triangles.push_back({left[(best + n - 1) % n], left[best], left[(best + 1) % n]});
    left.erase(left.begin() + static_cast<std::ptrdiff_t>(best));
  }
  triangles.push_back({left[0], left[1], left[2]});
  return triangles;
}

}  // namespace ensonify
