#pragma once

#include <opencv2/core.hpp>

#include "ensonify/core/image2.hpp"

namespace ensonify {

/// The image as OpenCV's type, without a copy. OpenCV has no const view: only for arguments that it reads.
inline cv::Mat mat_view(const Image2<float>& image) {
  return {image.rows(), image.columns(), CV_32F, const_cast<float*>(image.pixels().data())};
}

/// A copy, less `border` pixels on every side.
inline Image2<float> from_mat(const cv::Mat& mat, int border = 0) {
  Image2<float> image(mat.rows - 2 * border, mat.cols - 2 * border);
  cv::Mat view = mat_view(image);
  mat(cv::Rect(border, border, image.columns(), image.rows())).convertTo(view, CV_32F);
  return image;
}

}  // namespace ensonify
