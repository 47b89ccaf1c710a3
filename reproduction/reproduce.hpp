#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "ensonify/reproduction/findings.hpp"

namespace ensonify {

struct ReproduceOptions {
  std::filesystem::path out;
  std::string scale = "quick";
  std::optional<std::filesystem::path> data;    ///< a dataset in place of the recipe paper's
  std::optional<std::filesystem::path> models;  ///< where scripts/train_models left the networks from few pairs
  std::optional<std::filesystem::path> real;    ///< a folder of real pings, PNG
  OnProgress on_progress = [](const std::string&, int, int) {};
};

/// Makes the data, runs filters, maps and the closed loop, and keeps what each stage found below `out`: called
/// again, it goes on after the last one. All numbers are written to `out`/numbers as CSV and JSON. The same seed gives
/// the same numbers, but for times. Stages whose inputs are missing are left out and named. Throws ConfigError and
/// DataError: wrong options, broken data, a full disk.
Findings reproduce(const ReproduceOptions& options);

}  // namespace ensonify
