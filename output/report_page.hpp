#pragma once

#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "ensonify/core/colour.hpp"
#include "ensonify/core/image2.hpp"
#include "ensonify/output/contact_sheet.hpp"
#include "ensonify/output/plot.hpp"
#include "ensonify/output/report_table.hpp"

namespace ensonify {

/// A figure and its numbers. The page counts figures.
struct ReportFigure {
  std::string title;    ///< few words, in front of the caption
  std::string caption;  ///< what is shown, of how many frames, how the numbers were got
  std::string alt;      ///< for those who do not see it
  std::variant<PlotSheet, Image2<Rgb>, ContactSheet> picture;
  std::vector<ReportTable> tables;
  bool wide = false;  ///< not beside others, however wide the window
};

struct ReportSection {
  std::string title;
  std::vector<std::string> paragraphs;
  std::vector<ReportTable> tables;
  std::vector<ReportFigure> figures;
  std::vector<ReportSection> parts = {};  ///< below the figures; their own parts are not shown
};

/// Where numbers come from.
struct ReportSource {
  std::string line;                                        ///< for captions: name, seed, start of the root hash
  std::vector<std::pair<std::string, std::string>> facts;  ///< name and value, for the head of a page
};

struct ReportPage {
  std::string title, lead;
  std::vector<std::pair<std::string, std::string>> facts;  ///< as of ReportSource
  std::vector<ReportSection> sections;
};

/// One plot as a figure shows it: small, with letters that stay legible on a phone, without a title of its own.
PlotSheet figure_of(Plot plot, int width = 440, int height = 310);

/// The page as one HTML file that needs nothing else: style, plots (SVG) and pictures (PNG) within, no scripts. All
/// texts are escaped. The same bytes for the same page. Where gnuplot is missing, plots are left out and the page says
/// so.
std::string html_page(const ReportPage& page);

}  // namespace ensonify
