#include "ensonify/output/report_page.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "ensonify/core/error.hpp"
#include "ensonify/output/html_text.hpp"
#include "ensonify/output/inline_svg.hpp"
#include "ensonify/output/png.hpp"
#include "ensonify/output/report_style.hpp"

namespace ensonify {
namespace {

/// Least width of a row's tiles: pictures are 5.2 rem high (pairs of square ones then stand two by two on a phone), and
/// captions have their room.
double width_rem(const ContactRow& row) {
  double widest = 0;
  for (const ContactTile& tile : row.tiles) {
    double aspect = 0;
    for (const auto& picture : tile.pictures)
      aspect += picture.columns() / static_cast<double>(std::max(1, picture.rows()));
    widest = std::max(widest, aspect);
  }
  return std::clamp(std::round(52 * widest) / 10, 6.5, 20.0);
}

/// Writes the body, counting figures and what keeps plots from being drawn.
class Writer {
 public:
  void put(const ReportSection& section, const std::string& id, int level) {
    html_ += fmt::format("<h{0} id=\"{1}\">{2}</h{0}>\n", level, id, escaped(section.title));
    for (const std::string& text : section.paragraphs) html_ += fmt::format("<p>{}</p>\n", escaped(text));
    for (const ReportTable& table : section.tables) html_ += html_table(table);
    if (!section.figures.empty()) {
      html_ += "<div class=\"figures\">\n";
      for (const ReportFigure& figure : section.figures) put(figure);
      html_ += "</div>\n";
    }
    if (level > 2) return;
    for (std::size_t i = 0; i < section.parts.size(); ++i) put(section.parts[i], fmt::format("{}-{}", id, i + 1), 3);
  }

  const std::string& html() const { return html_; }
  const std::string& missing() const { return missing_; }

 private:
  void put(const ReportFigure& figure) {
    ++figures_;
    html_ += fmt::format("<figure id=\"figure-{}\"{}>\n", figures_, figure.wide ? " class=\"wide\"" : "");
    std::visit([&](const auto& picture) { put(picture, figure); }, figure.picture);
    html_ += fmt::format("<figcaption><b>Figure {}. {}.</b> {}</figcaption>\n", figures_, escaped(figure.title),
                         escaped(figure.caption));
    for (const ReportTable& table : figure.tables) html_ += html_table(table);
    html_ += "</figure>\n";
  }

  void put(const PlotSheet& sheet, const ReportFigure& figure) {
    try {
      const std::vector<std::uint8_t> svg = draw_plots(sheet, PlotFormat::svg);
      const std::string_view text(reinterpret_cast<const char*>(svg.data()), svg.size());
      html_ += inline_svg(text, fmt::format("f{}-", figures_), figure.alt) + "\n";
    } catch (const DataError& e) {
      missing_ = e.what();
      html_ += "<p class=\"missing\">This plot could not be drawn; its numbers follow.</p>\n";
    }
  }

  void put(const Image2<Rgb>& image, const ReportFigure& figure) {
    html_ += fmt::format("<img src=\"{}\" alt=\"{}\" width=\"{}\" height=\"{}\">\n", png_uri(encode_png(image)),
                         escaped(figure.alt), image.columns(), image.rows());
  }

  void put(const ContactSheet& sheet, const ReportFigure& figure) {
    html_ += fmt::format("<div class=\"sheet\" role=\"group\" aria-label=\"{}\">\n", escaped(figure.alt));
    for (const ContactRow& row : sheet.rows) {
      html_ += fmt::format("<p class=\"label\">{}</p>\n<div class=\"tiles\" style=\"grid-template-columns: ",
                           escaped(row.label));
      html_ += fmt::format("repeat(auto-fit, minmax(min(100%, {:g}rem), 1fr))\">\n", width_rem(row));
      for (const ContactTile& tile : row.tiles) put(tile, row.label);
      html_ += "</div>\n";
    }
    html_ += "</div>\n";
  }

  void put(const ContactTile& tile, const std::string& label) {
    html_ += "<div class=\"tile\"><div>";
    for (std::size_t i = 0; i < tile.pictures.size(); ++i) {
      const Image2<std::uint8_t>& picture = tile.pictures[i];
      const std::string alt = fmt::format("{}, {}, picture {}", label, tile.caption, i + 1);
      html_ += fmt::format("<img src=\"{}\" alt=\"{}\" width=\"{}\" height=\"{}\">", png_uri(encode_png(picture)),
                           escaped(alt), picture.columns(), picture.rows());
    }
    html_ += fmt::format("</div><span>{}</span></div>\n", escaped(tile.caption));
  }

  std::string html_, missing_;
  int figures_ = 0;
};

/// Anchors of the sections, no two alike.
std::vector<std::string> anchors_of(const ReportPage& page) {
  std::vector<std::string> anchors;
  std::set<std::string> taken;
  for (const ReportSection& section : page.sections) {
    const std::string word = anchor_of(section.title);
    std::string anchor = word;
    for (int i = 2; !taken.insert(anchor).second; ++i) anchor = fmt::format("{}-no{}", word, i);
    anchors.push_back("s-" + anchor);  // no figure's id starts like this
  }
  return anchors;
}

std::string head_of(const ReportPage& page) {
  // Belt and braces: even if a text got through as a tag, the browser would load and run nothing.
  constexpr const char* policy = "default-src 'none'; img-src data:; style-src 'unsafe-inline'";
  return fmt::format(
      "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
      "<meta http-equiv=\"Content-Security-Policy\" content=\"{}\">\n"
      "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n"
      "<title>{}</title>\n<style>{}</style>\n</head>\n",
      policy, escaped(page.title), report_style());
}

std::string opening_of(const ReportPage& page, const std::vector<std::string>& anchors, const std::string& missing) {
  std::string html = fmt::format("<header>\n<h1>{}</h1>\n", escaped(page.title));
  html += fmt::format("<p class=\"lead\">{}</p>\n", escaped(page.lead));
  if (!missing.empty()) html += fmt::format("<p class=\"missing\">Plots are missing: {}.</p>\n", escaped(missing));
  if (!page.facts.empty()) html += "<dl>\n";
  for (const auto& [name, value] : page.facts) {
    html += fmt::format("<dt>{}</dt><dd>{}</dd>\n", escaped(name), escaped(value));
  }
  if (!page.facts.empty()) html += "</dl>\n";
  html += "<nav aria-label=\"Contents\">\n<ul>\n";
  for (std::size_t i = 0; i < anchors.size(); ++i) {
    html += fmt::format("<li><a href=\"#{}\">{}</a></li>\n", anchors[i], escaped(page.sections[i].title));
  }
  return html + "</ul>\n</nav>\n</header>\n";
}

}  // namespace

PlotSheet figure_of(Plot plot, int width, int height) {
  plot.title.clear();
  return {{std::move(plot)}, 1, width, height, 12};
}

std::string html_page(const ReportPage& page) {
  const std::vector<std::string> anchors = anchors_of(page);
  Writer writer;
  for (std::size_t i = 0; i < page.sections.size(); ++i) writer.put(page.sections[i], anchors[i], 2);
  return head_of(page) + "<body>\n" + opening_of(page, anchors, writer.missing()) + "<main>\n" + writer.html() +
         "</main>\n</body>\n</html>\n";
}

}  // namespace ensonify
