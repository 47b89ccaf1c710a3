#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace ensonify {

/// Runs a program of the search path (no shell between) with `input` on its standard input, and returns what it writes
/// to standard output. Throws DataError where it can not be started, does not end with 0, or writes nothing; the
/// message carries what it said on standard error and `cure`.
std::vector<std::uint8_t> run_program(const std::vector<std::string>& words, std::span<const std::uint8_t> input,
                                      const std::string& cure);

}  // namespace ensonify
