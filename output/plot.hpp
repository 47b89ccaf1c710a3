#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "ensonify/core/colour.hpp"
#include "ensonify/core/image2.hpp"

namespace ensonify {

/// One curve, or set of marks, of a plot. x and y are equally long; a NaN interrupts a line.
struct Series {
  enum class Style { line, thin_line, marked_line, points, points_with_errors, bars, bars_with_errors };
  std::string name;  ///< in the legend; empty: not named there
  std::vector<double> x, y;
  Style style = Style::line;
  std::vector<double> y_low = {}, y_high = {};  ///< of *_with_errors; NaN: none there
};

/// A picture under the curves, its outer edges at these coordinates (row 0 on top).
struct Backdrop {
  Image2<Rgb> picture;
  double x_min = 0, x_max = 1, y_min = 0, y_max = 1;
};

struct Plot {
  std::string title, x_label, y_label;
  std::vector<Series> series;
  std::optional<Backdrop> backdrop = {};
  std::optional<std::pair<double, double>> x_range = {}, y_range = {};  ///< none: from the data
  bool equal_scale = false;                                             ///< a unit of x is as long as one of y
  std::vector<std::string> categories = {};                             ///< names of x = 0, 1, 2, ...
  bool sideways = false;  ///< x downwards and y to the right: room for long names; for points_with_errors alone
};

Plot titled_plot(std::string title, std::string x_label, std::string y_label);

/// Plots side by side, row by row.
struct PlotSheet {
  std::vector<Plot> plots;
  int columns = 1;
  int width = 900, height = 600;  ///< pixels of the whole sheet
  int font_size = 10;             ///< pixels
};

enum class PlotFormat { png, svg };

/// Draws the sheet with gnuplot (5.4, a program of its own: nothing is written but the bytes returned).
/// Throws DataError where gnuplot is missing or fails.
std::vector<std::uint8_t> draw_plots(const PlotSheet& sheet, PlotFormat format = PlotFormat::png);

}  // namespace ensonify
