#include "ensonify/filters/finishing.hpp"

#include <algorithm>
#include <opencv2/imgproc.hpp>

#include "ensonify/filters/mat_view.hpp"

namespace ensonify {

Image2<float> apply(const Threshold& f, const GreyImage& image) {
  Image2<float> mask(image.grey.rows(), image.grey.columns());
  std::ranges::transform(image.grey.pixels(), mask.pixels().begin(), [&](float x) { return x >= f.t ? 255.0F : 0.0F; });
  return mask;
}

Image2<float> apply(const Mask& f, const GreyImage& image, const GreyImage& raw) {
  Image2<float> kept(image.grey.rows(), image.grey.columns());
  std::ranges::transform(image.grey.pixels(), raw.grey.pixels(), kept.pixels().begin(),
                         [&](float x, float from_raw) { return x >= f.t ? from_raw : 0.0F; });
  return kept;
}

Image2<float> apply(const Unsharp& f, const GreyImage& image) {
  cv::Mat smooth;
  cv::GaussianBlur(mat_view(image.grey), smooth, {}, f.sigma, f.sigma, cv::BORDER_REFLECT_101);
  Image2<float> out = from_mat(smooth);
  const auto amount = static_cast<float>(f.amount);
  std::ranges::transform(image.grey.pixels(), out.pixels(), out.pixels().begin(), [=](float sharp, float blurred) {
    return std::clamp(sharp + amount * (sharp - blurred), 0.0F, 255.0F);
  });
  return out;
}

Image2<float> apply(const Equalize&, const GreyImage& image) {
  cv::Mat whole, equal;
  mat_view(image.grey).convertTo(whole, CV_8U);
  cv::equalizeHist(whole, equal);
  return from_mat(equal);
}

}  // namespace ensonify
