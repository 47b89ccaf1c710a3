#include <fmt/format.h>

#include <Eigen/Core>

#include "ensonify/core/error.hpp"
#include "ensonify/filters/diffusion.hpp"

namespace ensonify {
namespace {

using Array = Eigen::Array<float, Eigen::Dynamic, 1>;

/// c(d) d / step, in place.
void to_flux(Array& d, Array& scratch, const Anisodiff& f, float step) {
  const auto kappa = static_cast<float>(f.kappa);
  if (f.option == 1) {
    scratch = (-(d / kappa).square()).exp();
  } else if (f.option == 2) {
    scratch = 1.0F / (1.0F + (d / kappa).square());
  } else {
    scratch = 0.5F * (1.0F - (d / kappa).square() * 0.5F).max(0.0F).square();
  }
  d = scratch * d / step;
}

}  // namespace

void check(const Anisodiff& f) {
  const double most = 1.0 / (2.0 / f.step_row + 2.0 / f.step_col);
  if (f.gamma <= most) return;
  throw ConfigError(
      fmt::format("anisodiff: gamma = {:g} is unstable with step_row = {:g} and step_col = {:g}: at most {:g}", f.gamma,
                  f.step_row, f.step_col, most));
}

Image2<float> apply(const Anisodiff& f, const GreyImage& image) {
  check(f);
  Image2<float> out = image.grey;
  const int rows = out.rows(), columns = out.columns();
  const auto gamma = static_cast<float>(f.gamma);
  const auto step_row = static_cast<float>(f.step_row), step_col = static_cast<float>(f.step_col);
  const auto row_of = [&](int i) { return Eigen::Map<Array>(out.row(i).data(), columns); };
  Array above(columns), below(columns), along(columns - 1), scratch(columns), along_scratch(columns - 1),
      change(columns);
  for (int n = 0; n < f.iterations; ++n) {
    above.setZero();
    for (int i = 0; i < rows; ++i) {
      auto row = row_of(i);
      if (i + 1 < rows) {
        below = row_of(i + 1) - row;
        to_flux(below, scratch, f, step_row);
      } else {
        below.setZero();
      }
      change = below - above;
      if (columns > 1) {
        along = row.tail(columns - 1) - row.head(columns - 1);
        to_flux(along, along_scratch, f, step_col);
        change.head(columns - 1) += along;
        change.tail(columns - 1) -= along;
      }
      row += gamma * change;
      above.swap(below);
    }
  }
  return out;
}

}  // namespace ensonify
