#include "ensonify/evaluation/mask_scores.hpp"

#include <algorithm>
#include <limits>

namespace ensonify {
namespace {

double share(double part, double whole) { return whole > 0 ? part / whole : std::numeric_limits<double>::quiet_NaN(); }

}  // namespace

MaskCounts& MaskCounts::operator+=(const MaskCounts& other) {
  true_positive += other.true_positive;
  false_positive += other.false_positive;
  false_negative += other.false_negative;
  return *this;
}

double MaskCounts::precision() const {
  return share(static_cast<double>(true_positive), static_cast<double>(true_positive + false_positive));
}
double MaskCounts::recall() const {
  return share(static_cast<double>(true_positive), static_cast<double>(true_positive + false_negative));
}
double MaskCounts::iou() const {
  return share(static_cast<double>(true_positive),
               static_cast<double>(true_positive + false_positive + false_negative));
}
double MaskCounts::f1() const {
  return share(2.0 * static_cast<double>(true_positive),
               static_cast<double>(2 * true_positive + false_positive + false_negative));
}

LevelCounts& LevelCounts::operator+=(const LevelCounts& other) {
  for (std::size_t level = 0; level < echo.size(); ++level) {
    echo[level] += other.echo[level];
    background[level] += other.background[level];
  }
  return *this;
}

MaskCounts LevelCounts::at(int t) const {
  MaskCounts counts;
  for (std::size_t level = 0; level < echo.size(); ++level) {
    const bool set = static_cast<int>(level) >= t;
    (set ? counts.true_positive : counts.false_negative) += echo[level];
    if (set) counts.false_positive += background[level];
  }
  return counts;
}

int LevelCounts::best_threshold() const {
  int best = 1;
  double best_iou = -1.0;
  for (int t = 1; t < 256; ++t) {
    if (const double iou = at(t).iou(); iou > best_iou) {
      best = t;
      best_iou = iou;
    }
  }
  return best;
}

LevelCounts count_levels(const Image2<float>& image, const Image2<std::uint8_t>& mask) {
  LevelCounts counts;
  for (std::size_t i = 0; i < image.size(); ++i) {
    const auto level = static_cast<std::size_t>(std::clamp(image.pixels()[i], 0.0F, 255.0F));
    ++(mask.pixels()[i] != 0 ? counts.echo : counts.background)[level];
  }
  return counts;
}

}  // namespace ensonify
