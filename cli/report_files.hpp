#pragma once

#include <filesystem>

#include "ensonify/output/plot.hpp"
#include "ensonify/output/report_page.hpp"

namespace ensonify::cli {

/// Writes the sheet as a PNG. Where gnuplot is missing: an error, or with `beside_report` a word on standard error,
/// because the report holds the numbers and says the same.
void write_plots(const std::filesystem::path& path, const PlotSheet& sheet, bool beside_report);

/// Writes the page and says where: the last line of a command's output.
void write_report(const std::filesystem::path& path, const ReportPage& page);

}  // namespace ensonify::cli
