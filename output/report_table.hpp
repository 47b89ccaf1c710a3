#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace ensonify {

/// A table of texts. The first `heads` cells of a row name it and stand left; the others are numbers and stand right.
struct ReportTable {
  std::string caption;
  std::vector<std::string> columns;
  std::vector<std::vector<std::string>> rows;
  int heads = 1;
  bool open = false;  ///< not folded, however long
};

/// A number with so many digits after the point; "–" where it is none.
std::string fixed(double value, int digits);

/// A number with so many significant digits; "–" where it is none.
std::string significant(double value, int digits);

/// A share as a percentage, without its sign: "12.3".
std::string percent(double share, int digits = 1);

/// What can follow from a reader's screen: within a box of its own that scrolls, and, where there are many rows,
/// folded.
std::string html_table(const ReportTable& table);

}  // namespace ensonify
