#pragma once

#include <string>
#include <vector>

namespace ensonify::cli {

/// What `stats DIR --against FOLDER` was asked for.
struct AgainstArguments {
  std::string folder, real, out, split = "test";
  std::vector<std::string> regions;
  int max_images = 0;      ///< 0: the default
  double least_level = 0;  ///< grey level
  bool json = false;
  std::string progress = "auto";
};

/// Measures both sides, writes against.json, against.png and against_pings.png and prints a table.
void run_against(const AgainstArguments& a);

}  // namespace ensonify::cli
