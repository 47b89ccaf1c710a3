#include "ensonify/output/plot.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "ensonify/output/child_process.hpp"

namespace ensonify {
namespace {

/// Distinct also in grey: Okabe and Ito 2008, darkest first, each with a dash of its own.
constexpr std::array colours{"#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#56b4e9", "#555555"};
constexpr std::array dashes{1, 2, 4, 5, 3};
constexpr std::array<std::size_t, colours.size()> first_dash{0, 1, 2, 3, 0, 1, 4};

/// Full and open shapes by turns, so that neighbours are told apart in grey too.
constexpr std::array marks{7, 4, 9, 12, 5, 6, 2};
static_assert(marks.size() == colours.size());

/// Series beyond the colours begin them again with other dashes and marks: no two of the first 35 look alike.
constexpr std::size_t line_types = colours.size() * dashes.size();

std::string style_lines() {
  std::string lines;
  for (std::size_t i = 0; i < line_types; ++i) {
    const std::size_t round = i / colours.size();
    const std::size_t colour = i % colours.size();
    const int dash = dashes[(first_dash[colour] + round) % dashes.size()];
    lines += fmt::format("set linetype {} lc rgb '{}' lw 2 dt {}\n", i + 1, colours[colour], dash);
  }
  return lines;
}

/// A gnuplot string: escaped, without control characters and back quotes, which would run a program.
std::string quoted(const std::string& text) {
  std::string result = "\"";
  for (const char c : text) {
    if (static_cast<unsigned char>(c) < ' ' || c == '`') continue;
    if (c == '"' || c == '\\') result += '\\';
    result += c;
  }
  return result + "\"";
}

bool has_point(const Series& series) {
  for (std::size_t i = 0; i < std::min(series.x.size(), series.y.size()); ++i) {
    if (std::isfinite(series.x[i]) && std::isfinite(series.y[i])) return true;
  }
  return false;
}

std::string drawn(Series::Style style, std::size_t index) {
  const int mark = marks[(index + index / colours.size()) % marks.size()];
  switch (style) {
    case Series::Style::line:
      return "with lines";
    case Series::Style::thin_line:
      return "with lines lw 1 dt 1";
    case Series::Style::marked_line:
      return fmt::format("with linespoints pt {} ps 0.6 pn 9", mark);
    case Series::Style::points:
      return "with points pt 7 ps 0.5";
    case Series::Style::points_with_errors:
      return fmt::format("with xerrorbars pt {} ps 0.6 lw 1.5 dt 1", mark);
    case Series::Style::bars:
      return "with boxes fs solid 0.75 noborder";
    case Series::Style::bars_with_errors:
      return "with boxerrorbars fs solid 0.5 noborder";
  }
  return "";
}

bool has_errors(Series::Style style) {
  return style == Series::Style::bars_with_errors || style == Series::Style::points_with_errors;
}

const char* columns_of(Series::Style style) {
  if (style == Series::Style::points_with_errors) return "2:1:3:4";
  return style == Series::Style::bars_with_errors ? "1:2:3:4:(0.8)" : "1:2";
}

void put_data(std::string& script, const Series& series, std::size_t plot, std::size_t index) {
  script += fmt::format("$d{}_{} << EOD\n", plot, index);
  for (std::size_t i = 0; i < std::min(series.x.size(), series.y.size()); ++i) {
    if (std::isfinite(series.x[i]) && std::isfinite(series.y[i])) {
      script += fmt::format("{:.9g} {:.9g}", series.x[i], series.y[i]);
      if (has_errors(series.style)) {
        const auto or_y = [&](double end) { return std::isfinite(end) ? end : series.y[i]; };
        script += fmt::format(" {:.9g} {:.9g}", or_y(series.y_low.at(i)), or_y(series.y_high.at(i)));
      }
      script += "\n";
    } else {
      script += "\n";
    }
  }
  script += "EOD\n";
}

std::string range_of(const std::optional<std::pair<double, double>>& range) {
  return range ? fmt::format("[{:.9g}:{:.9g}]", range->first, range->second) : "[*:*]";
}

void put_axes(std::string& script, const Plot& plot) {
  const std::size_t names = plot.categories.size();
  if (plot.sideways) {
    script += fmt::format(
        "set xrange {}\nset yrange [{}:-0.5]\nset xtics auto norotate\nset ytics ()\nset key samplen 2\nset rmargin "
        "4\n",
        range_of(plot.y_range), static_cast<double>(names) - 0.5);
  } else {
    script +=
        fmt::format("set xrange {}\nset yrange {}\nset ytics auto\n", range_of(plot.x_range), range_of(plot.y_range));
    script += names == 0 ? "set xtics auto norotate\nset rmargin -1\n" : "set xtics rotate by -35 ()\nset rmargin 10\n";
  }
  for (std::size_t c = 0; c < names; ++c) {
    script += fmt::format("set {}tics add ({} {})\n", plot.sideways ? 'y' : 'x', quoted(plot.categories[c]), c);
  }
}

void put_plot(std::string& script, const Plot& plot, std::size_t at) {
  for (std::size_t s = 0; s < plot.series.size(); ++s) put_data(script, plot.series[s], at, s);
  const std::string x_label = quoted(plot.x_label), y_label = quoted(plot.y_label);
  script += fmt::format("set title {}\nset xlabel {}\nset ylabel {}\n", quoted(plot.title),
                        plot.sideways ? y_label : x_label, plot.sideways ? x_label : y_label);
  script += plot.equal_scale ? "set size ratio -1\n" : "set size noratio\n";
  put_axes(script, plot);
  std::string items;
  if (plot.backdrop) {
    const Backdrop& b = *plot.backdrop;
    const double dx = (b.x_max - b.x_min) / b.picture.columns(), dy = (b.y_max - b.y_min) / b.picture.rows();
    items = fmt::format(
        "'-' binary array=({},{}) format='%uchar' flipy dx={:.9g} dy={:.9g} origin=({:.9g},{:.9g}) with rgbimage "
        "notitle",
        b.picture.columns(), b.picture.rows(), dx, dy, b.x_min + 0.5 * dx, b.y_min + 0.5 * dy);
  }
  for (std::size_t s = 0; s < plot.series.size(); ++s) {
    if (!has_point(plot.series[s])) continue;
    if (!items.empty()) items += ", ";
    const Series::Style style = plot.series[s].style;
    items += fmt::format("$d{}_{} using {} {} lt {} title {}", at, s, columns_of(style), drawn(style, s),
                         s % line_types + 1, quoted(plot.series[s].name));
  }
  if (items.empty()) items = "[0:1][0:1] 2 notitle";  // an empty frame: gnuplot refuses to draw nothing
  script += "plot " + items + "\n";
  if (plot.backdrop) {
    for (const Rgb p : plot.backdrop->picture.pixels()) {
      script += {static_cast<char>(p.red), static_cast<char>(p.green), static_cast<char>(p.blue)};
    }
  }
}

}  // namespace

Plot titled_plot(std::string title, std::string x_label, std::string y_label) {
  Plot plot;
  plot.title = std::move(title);
  plot.x_label = std::move(x_label);
  plot.y_label = std::move(y_label);
  return plot;
}

std::vector<std::uint8_t> draw_plots(const PlotSheet& sheet, PlotFormat format) {
  const int columns = std::max(1, sheet.columns);
  const int rows = (static_cast<int>(sheet.plots.size()) + columns - 1) / columns;
  std::string script =
      fmt::format("set terminal {} size {},{} noenhanced font 'DejaVu Sans,{}' background '#ffffff'\n",
                  format == PlotFormat::png ? "pngcairo" : "svg", sheet.width, sheet.height, sheet.font_size);
  script += style_lines();
  script += "set encoding utf8\nset grid lc rgb '#cccccc' lw 0.5\nset border lw 0.7\nset tics out nomirror\n";
  script += "set style data lines\nset boxwidth 0.9 relative\nset key tmargin center horizontal noenhanced\n";
  script += fmt::format("set multiplot layout {},{}\n", std::max(1, rows), columns);
  for (std::size_t i = 0; i < sheet.plots.size(); ++i) put_plot(script, sheet.plots[i], i);
  script += "unset multiplot\n";
  const std::span bytes(reinterpret_cast<const std::uint8_t*>(script.data()), script.size());
  return run_program({"gnuplot", "-"}, bytes, "plots need gnuplot (Debian: gnuplot-nox)");
}

}  // namespace ensonify
