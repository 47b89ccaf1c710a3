#pragma once

#include <cstddef>
#include <filesystem>
#include <map>
#include <string>

#include "ensonify/output/npy.hpp"

namespace ensonify {

/// Most bytes that one array of a file may unpack to: a few kilobytes of zip can claim terabytes.
constexpr std::size_t default_max_array_bytes = std::size_t{1} << 31;

/// Named arrays as numpy.load reads them. The same arrays give the same bytes at any time and in any time zone.
void write_npz(const std::filesystem::path& path, const std::map<std::string, NpyArray>& arrays);

/// Throws DataError: no such file, not a .npz, cut off, or an array larger than `max_array_bytes`.
std::map<std::string, NpyArray> read_npz(const std::filesystem::path& path,
                                         std::size_t max_array_bytes = default_max_array_bytes);

}  // namespace ensonify
