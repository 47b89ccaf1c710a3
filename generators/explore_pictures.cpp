#include "ensonify/generators/explore_pictures.hpp"

#include <algorithm>
#include <cmath>

#include "ensonify/output/fan_view.hpp"

namespace ensonify {
namespace {

constexpr int height_px = 420;
constexpr int gap_px = 6;
constexpr Rgb white{255, 255, 255}, black{0, 0, 0}, grey{150, 150, 150}, blue{30, 90, 220}, orange{240, 120, 0},
    green{205, 240, 205}, red{200, 30, 30}, paper{60, 60, 60};

Image2<Rgb> fan_of(const Image2<std::uint8_t>& image, const SonarGeometry& geometry) {
  const Image2<std::uint8_t> fan = fan_view(image, geometry, height_px);
  Image2<Rgb> picture(fan.rows(), fan.columns());
  std::ranges::transform(fan.pixels(), picture.pixels().begin(), [](std::uint8_t v) { return Rgb{v, v, v}; });
  return picture;
}

Image2<std::uint8_t> rounded(const Image2<float>& image) {
  Image2<std::uint8_t> whole(image.rows(), image.columns());
  std::ranges::transform(image.pixels(), whole.pixels().begin(),
                         [](float v) { return static_cast<std::uint8_t>(std::lround(std::clamp(v, 0.0F, 255.0F))); });
  return whole;
}

/// A slice on paper, north up.
class Chart {
 public:
  explicit Chart(const Slice& slice) : slice_(&slice), scale_(static_cast<double>(height_px) / slice.frame.size[1]) {
    picture_ = Image2<Rgb>(height_px, std::max(1, static_cast<int>(scale_ * slice.frame.size[0])));
  }

  template <typename ColourOf>
  void fill(const ColourOf& colour_of) {
    for (int row = 0; row < picture_.rows(); ++row) {
      const int iy = std::min(slice_->frame.size[1] - 1, static_cast<int>((picture_.rows() - 1 - row) / scale_));
      for (int column = 0; column < picture_.columns(); ++column) {
        const int ix = std::min(slice_->frame.size[0] - 1, static_cast<int>(column / scale_));
        picture_(row, column) = colour_of(slice_->index(ix, iy));
      }
    }
  }

  void line(double x0, double y0, double x1, double y1, Rgb colour) {
    const int pieces = 1 + static_cast<int>(std::hypot(x1 - x0, y1 - y0) / slice_->frame.resolution_m * scale_ * 2);
    for (int i = 0; i <= pieces; ++i) {
      dot(x0 + (x1 - x0) * i / pieces, y0 + (y1 - y0) * i / pieces, colour);
    }
  }

  void vehicle(const PlanarPose& at, double radius_m) {
    PlanarPose last{at.x_m + radius_m, at.y_m, 0};
    for (int i = 1; i <= 48; ++i) {
      const double angle = radians(7.5 * i);
      const PlanarPose next{at.x_m + radius_m * std::cos(angle), at.y_m + radius_m * std::sin(angle), 0};
      line(last.x_m, last.y_m, next.x_m, next.y_m, orange);
      last = next;
    }
    line(at.x_m, at.y_m, at.x_m + 2 * radius_m * std::cos(at.yaw_rad), at.y_m + 2 * radius_m * std::sin(at.yaw_rad),
         orange);
  }

  Image2<Rgb> picture() && { return std::move(picture_); }

 private:
  void dot(double x, double y, Rgb colour) {
    const double per_m = scale_ / slice_->frame.resolution_m;
    const int column = static_cast<int>((x - slice_->frame.origin_m.x()) * per_m);
    const int row = picture_.rows() - 1 - static_cast<int>((y - slice_->frame.origin_m.y()) * per_m);
    if (row >= 0 && column >= 0 && row < picture_.rows() && column < picture_.columns()) picture_(row, column) = colour;
  }

  const Slice* slice_;
  double scale_;
  Image2<Rgb> picture_;
};

Rgb colour_of(ColumnState state) {
  if (state == ColumnState::occupied) return black;
  return state == ColumnState::free ? white : grey;
}

Image2<Rgb> side_by_side(const std::vector<Image2<Rgb>>& pictures) {
  int width = -gap_px;
  for (const auto& picture : pictures) width += picture.columns() + gap_px;
  Image2<Rgb> strip(height_px, width, paper);
  int left = 0;
  for (const auto& picture : pictures) {
    for (int row = 0; row < picture.rows(); ++row) {
      std::ranges::copy(picture.row(row), strip.row(row).begin() + left);
    }
    left += picture.columns() + gap_px;
  }
  return strip;
}

}  // namespace

Image2<Rgb> explore_strip(const ExplorePing& ping, const SonarGeometry& geometry, const Slice& map,
                          const std::vector<ExploreStep>& so_far, const ExploreSite& site, double radius_m) {
  Chart believed(map);
  believed.fill([&](std::size_t i) { return colour_of(map.columns[i]); });
  Chart truth(site.truth);
  truth.fill([&](std::size_t i) {
    if (site.reachable.boundary[i] != 0) return red;
    return site.reachable.free[i] != 0 ? green : colour_of(site.truth.columns[i]);
  });
  for (std::size_t i = 1; i < so_far.size(); ++i) {
    const auto draw = [&](Chart& chart, const Pose& from, const Pose& to) {
      chart.line(from.translation().x(), from.translation().y(), to.translation().x(), to.translation().y(), blue);
    };
    draw(believed, so_far[i - 1].T_world_sonar_est, so_far[i].T_world_sonar_est);
    draw(truth, so_far[i - 1].T_world_sonar, so_far[i].T_world_sonar);
  }
  believed.vehicle(planar(so_far.back().T_world_sonar_est), radius_m);
  truth.vehicle(planar(so_far.back().T_world_sonar), radius_m);
  return side_by_side({fan_of(ping.raw, geometry), fan_of(rounded(ping.filtered), geometry),
                       std::move(believed).picture(), std::move(truth).picture()});
}

}  // namespace ensonify
