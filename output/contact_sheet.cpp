#include "ensonify/output/contact_sheet.hpp"

#include <algorithm>
#include <cstring>
#include <opencv2/imgproc.hpp>

namespace ensonify {
namespace {

constexpr int margin = 12;
constexpr int picture_gap = 2;
constexpr int tile_gap = 10;
constexpr int title_height = 26;
constexpr int label_height = 18;
constexpr int caption_height = 15;
const cv::Scalar paper(255, 255, 255), ink(30, 30, 30);

/// OpenCV's letters are ASCII.
std::string plain(const std::string& text) {
  std::string result;
  for (const char c : text) {
    const auto u = static_cast<unsigned char>(c);
    if ((u & 0xc0) == 0x80) continue;  // further bytes of one UTF-8 letter
    result += u >= ' ' && u < 0x7f ? c : '?';
  }
  return result;
}

void write(cv::Mat& canvas, const std::string& text, int x, int baseline, double scale) {
  cv::putText(canvas, plain(text), {x, baseline}, cv::FONT_HERSHEY_SIMPLEX, scale, ink, 1, cv::LINE_AA);
}

cv::Size size_of(const ContactTile& tile) {
  int width = 0, height = 0;
  for (const auto& picture : tile.pictures) {
    width += picture.columns() + (width > 0 ? picture_gap : 0);
    height = std::max(height, picture.rows());
  }
  return {width, height};
}

void draw(const ContactTile& tile, cv::Mat& canvas, int x, int y) {
  const int bottom = y + size_of(tile).height;
  write(canvas, tile.caption, x, bottom + 11, 0.35);
  for (const auto& picture : tile.pictures) {
    const cv::Mat grey(picture.rows(), picture.columns(), CV_8U, const_cast<std::uint8_t*>(picture.pixels().data()));
    cv::cvtColor(grey, canvas(cv::Rect(x, y, picture.columns(), picture.rows())), cv::COLOR_GRAY2BGR);
    x += picture.columns() + picture_gap;
  }
}

}  // namespace

Image2<std::uint8_t> resized(const Image2<std::uint8_t>& image, int rows, int columns) {
  const cv::Mat from(image.rows(), image.columns(), CV_8U, const_cast<std::uint8_t*>(image.pixels().data()));
  Image2<std::uint8_t> result(rows, columns);
  cv::Mat to(rows, columns, CV_8U, result.pixels().data());
  cv::resize(from, to, to.size(), 0, 0, cv::INTER_AREA);
  return result;
}

Image2<Rgb> draw_contact_sheet(const ContactSheet& sheet) {
  cv::Size tile{1, 1};
  std::size_t columns = 1;
  for (const ContactRow& row : sheet.rows) {
    columns = std::max(columns, row.tiles.size());
    for (const ContactTile& t : row.tiles) {
      const cv::Size size = size_of(t);
      tile = {std::max(tile.width, size.width), std::max(tile.height, size.height)};
    }
  }
  const int row_height = label_height + tile.height + caption_height + tile_gap;
  const int width = std::max(2 * margin + static_cast<int>(columns) * (tile.width + tile_gap) - tile_gap, 420);
  const int height = 2 * margin + title_height + static_cast<int>(sheet.rows.size()) * row_height;
  cv::Mat canvas(height, width, CV_8UC3, paper);
  write(canvas, sheet.title, margin, margin + 14, 0.5);
  int y = margin + title_height;
  for (const ContactRow& row : sheet.rows) {
    write(canvas, row.label, margin, y + 12, 0.45);
    int x = margin;
    for (const ContactTile& t : row.tiles) {
      draw(t, canvas, x, y + label_height);
      x += tile.width + tile_gap;
    }
    y += row_height;
  }
  // All is grey, so the order of the channels does not matter.
  static_assert(sizeof(Rgb) == 3);
  Image2<Rgb> result(height, width);
  for (int r = 0; r < height; ++r) std::memcpy(result.row(r).data(), canvas.ptr(r), result.row(r).size_bytes());
  return result;
}

}  // namespace ensonify
