#include "ensonify/output/plot.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "ensonify/output/child_process.hpp"

namespace ensonify {
namespace {

/// Distinct also in grey: Okabe and Ito 2008, darkest first.
constexpr const char* style_lines =
    "set linetype 1 lc rgb '#0072b2' lw 2\n"
    "set linetype 2 lc rgb '#d55e00' lw 2 dt 2\n"
    "set linetype 3 lc rgb '#009e73' lw 2 dt 4\n"
    "set linetype 4 lc rgb '#cc79a7' lw 2 dt 5\n"
    "set linetype 5 lc rgb '#e69f00' lw 2\n"
    "set linetype 6 lc rgb '#56b4e9' lw 2 dt 2\n"
    "set linetype 7 lc rgb '#555555' lw 2 dt 3\n";

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

const char* drawn(Series::Style style) {
  switch (style) {
    case Series::Style::line:
      return "with lines";
    case Series::Style::thin_line:
      return "with lines lw 1 dt 1";
    case Series::Style::points:
      return "with points pt 7 ps 0.5";
    case Series::Style::bars:
      return "with boxes fs solid 0.75 noborder";
    case Series::Style::bars_with_errors:
      return "with boxerrorbars fs solid 0.5 noborder";
  }
  return "";
}

void put_data(std::string& script, const Series& series, std::size_t plot, std::size_t index) {
  script += fmt::format("$d{}_{} << EOD\n", plot, index);
  for (std::size_t i = 0; i < std::min(series.x.size(), series.y.size()); ++i) {
    if (std::isfinite(series.x[i]) && std::isfinite(series.y[i])) {
      script += fmt::format("{:.9g} {:.9g}", series.x[i], series.y[i]);
      if (series.style == Series::Style::bars_with_errors) {
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

void put_plot(std::string& script, const Plot& plot, std::size_t at) {
  for (std::size_t s = 0; s < plot.series.size(); ++s) put_data(script, plot.series[s], at, s);
  script += fmt::format("set title {}\nset xlabel {}\nset ylabel {}\n", quoted(plot.title), quoted(plot.x_label),
                        quoted(plot.y_label));
  script += fmt::format("set xrange {}\nset yrange {}\n", range_of(plot.x_range), range_of(plot.y_range));
  script += plot.equal_scale ? "set size ratio -1\n" : "set size noratio\n";
  script += plot.categories.empty() ? "set xtics auto norotate\nset rmargin -1\n"
                                    : "set xtics rotate by -35 ()\nset rmargin 10\n";
  for (std::size_t c = 0; c < plot.categories.size(); ++c) {
    script += fmt::format("set xtics add ({} {})\n", quoted(plot.categories[c]), c);
  }
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
    const bool errors = plot.series[s].style == Series::Style::bars_with_errors;
    items += fmt::format("$d{}_{} using {} {} lt {} title {}", at, s, errors ? "1:2:3:4:(0.8)" : "1:2",
                         drawn(plot.series[s].style), s % 7 + 1, quoted(plot.series[s].name));
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
  std::string script = fmt::format("set terminal {} size {},{} noenhanced font 'DejaVu Sans,10' background '#ffffff'\n",
                                   format == PlotFormat::png ? "pngcairo" : "svg", sheet.width, sheet.height);
  script += style_lines;
  script += "set encoding utf8\nset grid lc rgb '#cccccc' lw 0.5\nset border lw 0.7\nset tics out nomirror\n";
  script += "set style data lines\nset boxwidth 0.9 relative\nset key tmargin center horizontal noenhanced\n";
  script += fmt::format("set multiplot layout {},{}\n", std::max(1, rows), columns);
  for (std::size_t i = 0; i < sheet.plots.size(); ++i) put_plot(script, sheet.plots[i], i);
  script += "unset multiplot\n";
  const std::span bytes(reinterpret_cast<const std::uint8_t*>(script.data()), script.size());
  return run_program({"gnuplot", "-"}, bytes, "plots need gnuplot (Debian: gnuplot-nox)");
}

}  // namespace ensonify
