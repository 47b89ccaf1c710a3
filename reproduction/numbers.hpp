#pragma once

#include <filesystem>

#include "ensonify/reproduction/findings.hpp"

namespace ensonify {

/// All numbers of a report as CSV and JSON files in a folder; times.csv apart, since no two runs have the same.
void write_numbers(const Findings& findings, const std::filesystem::path& folder);

}  // namespace ensonify
