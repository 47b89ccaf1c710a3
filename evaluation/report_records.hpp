#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "ensonify/evaluation/filter_report.hpp"
#include "ensonify/evaluation/map_report.hpp"

/// Reports as they are kept between runs: JSON with all that they are made of, so that what is read back is the same to
/// the bit. The files for users are those of filter_report.hpp and map_report.hpp.
namespace ensonify {

std::string record_of(const FilterReport& report);
std::string record_of(const MapReport& report);

/// Throw DataError, naming `from`, where the text is no such record.
FilterReport filter_report_of(std::string_view record, const std::filesystem::path& from);
MapReport map_report_of(std::string_view record, const std::filesystem::path& from);

}  // namespace ensonify
