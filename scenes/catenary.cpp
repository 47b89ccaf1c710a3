#include "ensonify/scenes/catenary.hpp"

#include <cmath>

namespace ensonify {
namespace {

struct Curve {
  double a_m, lowest_x_m;

  double height_m(double x_m) const { return a_m * std::cosh((x_m - lowest_x_m) / a_m); }
  double arc_m(double x_m) const { return a_m * std::sinh((x_m - lowest_x_m) / a_m); }
};

/// The curve of half span / a = u through (0, 0) and (span, rise), up to a constant height.
Curve curve_of(double u, double span_m, double rise_m) {
  const double a = 0.5 * span_m / u;
  return {a, 0.5 * span_m - a * std::asinh(rise_m / (2 * a * std::sinh(u)))};
}

double sag_of(const Curve& curve, double span_m, double rise_m) {
  const double x = curve.lowest_x_m + curve.a_m * std::asinh(rise_m / span_m);  // where it runs along the chord
  return curve.height_m(0) + rise_m * x / span_m - curve.height_m(x);
}

}  // namespace

HangingLine::HangingLine(const Vec3& from_m, const Vec3& to_m, double sag_m)
    : from_m_(from_m), to_m_(to_m), length_m_((to_m - from_m).norm()), span_m_((to_m - from_m).head<2>().norm()) {
  if (sag_m <= 0) return;
  const double rise_m = to_m.z() - from_m.z();
  double low = 1e-6, high = 50;  // of u; the sag grows with it
  for (int i = 0; i < 200; ++i) {
    const double u = 0.5 * (low + high);
    (sag_of(curve_of(u, span_m_, rise_m), span_m_, rise_m) < sag_m ? low : high) = u;
  }
  // Below this the sag is lost in rounding.
  if (high < 1e-5) return;
  const Curve curve = curve_of(high, span_m_, rise_m);
  a_m_ = curve.a_m;
  lowest_x_m_ = curve.lowest_x_m;
  arc_at_from_m_ = curve.arc_m(0);
  length_m_ = curve.arc_m(span_m_) - arc_at_from_m_;
}

Vec3 HangingLine::at(double share) const {
  if (share <= 0) return from_m_;
  if (share >= 1) return to_m_;
  if (a_m_ == 0) return from_m_ + share * (to_m_ - from_m_);
  const Curve curve{a_m_, lowest_x_m_};
  const double x = lowest_x_m_ + a_m_ * std::asinh((arc_at_from_m_ + share * length_m_) / a_m_);
  Vec3 point = from_m_ + x / span_m_ * (to_m_ - from_m_);
  point.z() = from_m_.z() + curve.height_m(x) - curve.height_m(0);
  return point;
}

std::vector<Vec3> HangingLine::points_m(int pieces) const {
  std::vector<Vec3> points;
  for (int i = 0; i <= pieces; ++i) points.push_back(at(static_cast<double>(i) / pieces));
  return points;
}

}  // namespace ensonify
