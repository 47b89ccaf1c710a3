#include "ensonify/cli/report_files.hpp"

#include <fmt/format.h>

#include <cstdio>
#include <optional>

#include "ensonify/core/error.hpp"
#include "ensonify/output/atomic_file.hpp"

namespace ensonify::cli {

void write_plots(const std::filesystem::path& path, const PlotSheet& sheet, bool beside_report) {
  std::optional<std::vector<std::uint8_t>> png;
  try {
    png = draw_plots(sheet);
  } catch (const DataError& e) {
    if (!beside_report) throw;
    fmt::print(stderr, "ensonify: without {}: {}\n", path.string(), e.what());
    return;
  }
  write_file(path, *png);
}

void write_report(const std::filesystem::path& path, const ReportPage& page) {
  write_file(path, html_page(page));
  fmt::print("report: {}\n", path.string());
}

}  // namespace ensonify::cli
