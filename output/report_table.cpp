#include "ensonify/output/report_table.hpp"

#include <fmt/format.h>

#include <cmath>

#include "ensonify/output/html_text.hpp"

namespace ensonify {
namespace {

constexpr std::size_t most_open_rows = 12;
constexpr std::size_t longest_narrow = 14;  ///< letters of a column's name

std::string cell(const std::string& text, std::size_t column, const ReportTable& table) {
  const auto heads = static_cast<std::size_t>(table.heads);
  if (column < heads) return fmt::format("<th scope=\"row\">{}</th>", escaped(text));
  return fmt::format("<td>{}</td>", escaped(text));
}

}  // namespace

std::string fixed(double value, int digits) {
  if (!std::isfinite(value)) return "–";
  const std::string text = fmt::format("{:.{}f}", value, digits);
  return text.find_first_of("123456789") == text.npos && text.front() == '-' ? text.substr(1) : text;  // no "-0.00"
}

std::string significant(double value, int digits) {
  return std::isfinite(value) ? fmt::format("{:.{}g}", value, digits) : "–";
}

std::string percent(double share, int digits) { return fixed(100 * share, digits); }

std::string html_table(const ReportTable& table) {
  const std::string caption = escaped(table.caption);
  std::string html =
      fmt::format("<div class=\"scroll\" role=\"region\" tabindex=\"0\" aria-label=\"{}\">\n<table>\n", caption);
  html += fmt::format("<caption><span>{}</span></caption>\n<thead><tr>", caption);
  for (std::size_t c = 0; c < table.columns.size(); ++c) {
    const char* kind = c < static_cast<std::size_t>(table.heads)  ? " class=\"head\""
                       : table.columns[c].size() > longest_narrow ? " class=\"long\""
                                                                  : "";
    html += fmt::format("<th scope=\"col\"{}>{}</th>", kind, escaped(table.columns[c]));
  }
  html += "</tr></thead>\n<tbody>\n";
  for (const auto& row : table.rows) {
    html += "<tr>";
    for (std::size_t c = 0; c < row.size(); ++c) html += cell(row[c], c, table);
    html += "</tr>\n";
  }
  html += "</tbody>\n</table>\n</div>\n";
  if (table.open || table.rows.size() <= most_open_rows) return html;
  return fmt::format("<details>\n<summary>{} ({} rows)</summary>\n{}</details>\n", caption, table.rows.size(), html);
}

}  // namespace ensonify
