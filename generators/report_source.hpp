#pragma once

#include <string>
#include <utility>
#include <vector>

#include "ensonify/generators/dataset_reader.hpp"

namespace ensonify {

/// Where the numbers of a report come from.
struct ReportSource {
  std::string line;                                        ///< for captions: name, seed, start of the root hash
  std::vector<std::pair<std::string, std::string>> facts;  ///< name and value, for the head of the page
};

/// What a dataset's manifest says of it: no path, no time.
ReportSource report_source(const Dataset& dataset);

}  // namespace ensonify
