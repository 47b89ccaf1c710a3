#include "ensonify/filters/cfar.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>
#include <vector>

namespace ensonify {
namespace {

/// Rows of cells, [begin, end).
struct Cells {
  int begin = 0, end = 0;
  int count() const { return end - begin; }
};

struct Neighbours {
  Cells before, after;
};

/// The cells on both sides of a row that the image has. Rules that compare both sides take as many of one as of the
/// other.
Neighbours neighbours(const Cfar& f, int row, int rows) {
  Neighbours n{{std::max(row - f.guard - f.train, 0), std::max(row - f.guard, 0)},
               {std::min(row + f.guard + 1, rows), std::min(row + f.guard + 1 + f.train, rows)}};
  const int half = std::min(n.before.count(), n.after.count());
  if ((f.rule == CfarRule::soca || f.rule == CfarRule::goca) && half > 0) {
    n.before.begin = n.before.end - half;
    n.after.end = n.after.begin + half;
  }
  return n;
}

/// [i]: sum of the rows before i.
std::vector<std::vector<double>> sums_down(const Image2<double>& intensity) {
  std::vector<std::vector<double>> sums(intensity.rows() + 1, std::vector<double>(intensity.columns()));
  for (int i = 0; i < intensity.rows(); ++i) {
    for (int j = 0; j < intensity.columns(); ++j) sums[i + 1][j] = sums[i][j] + intensity(i, j);
  }
  return sums;
}

double ordered_cell(const Image2<double>& intensity, const Neighbours& n, int column, double rank,
                    std::vector<double>& cells) {
  cells.clear();
  for (const Cells& side : {n.before, n.after}) {
    for (int i = side.begin; i < side.end; ++i) cells.push_back(intensity(i, column));
  }
  const int order = std::clamp(static_cast<int>(std::ceil(rank * static_cast<double>(cells.size()))), 1,
                               static_cast<int>(cells.size()));
  std::nth_element(cells.begin(), cells.begin() + order - 1, cells.end());
  return cells[order - 1];
}

}  // namespace

Image2<float> apply(const Cfar& f, const GreyImage& image) {
  const int rows = image.grey.rows(), columns = image.grey.columns();
  Image2<double> intensity(rows, columns);
  std::ranges::transform(image.grey.pixels(), intensity.pixels().begin(), [&](float grey) {
    const double level = std::max(static_cast<double>(grey), 0.0);
    return f.exponent == 2.0 ? level * level : std::pow(level, f.exponent);
  });
  const auto sums = sums_down(intensity);
  Image2<float> mask(rows, columns);
  std::vector<double> cells;
  std::map<std::pair<int, int>, double> factors;  // by the numbers of cells, which differ only near the ends
  for (int i = 0; i < rows; ++i) {
    const Neighbours n = neighbours(f, i, rows);
    const int before = n.before.count(), after = n.after.count();
    if (before + after == 0) continue;  // nothing to compare with
    double& factor = factors[{before, after}];
    if (factor == 0.0) factor = cfar_factor(f.rule, before, after, f.pfa, f.rank);
    for (int j = 0; j < columns; ++j) {
      const double first = sums[n.before.end][j] - sums[n.before.begin][j];
      const double second = sums[n.after.end][j] - sums[n.after.begin][j];
      double background = (first + second) / (before + after);
      if (f.rule == CfarRule::os) {
        background = ordered_cell(intensity, n, j, f.rank, cells);
      } else if (f.rule != CfarRule::ca && before > 0 && after > 0) {
        background = (f.rule == CfarRule::soca ? std::min(first, second) : std::max(first, second)) / before;
      }
      mask(i, j) = intensity(i, j) > factor * background ? 255.0F : 0.0F;
    }
  }
  return mask;
}

}  // namespace ensonify
