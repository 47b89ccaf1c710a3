#pragma once

#include <string>

namespace ensonify::cli {

/// Opens what is closed of standard input, output and error, for nothing to be written to: else the next file that is
/// opened takes their place, and what is printed goes into it.
void hold_standard_streams();

/// The program's exit code after `code`: 1 where standard output did not take all that was printed, and says so. A
/// reader that has gone (`| head -1`) has seen what it wanted.
int finish_standard_output(int code);

/// Prints "ensonify: message" to standard error: cut at some length, and control characters as '?', since a message
/// quotes files that may hold anything.
void complain(const std::string& message);

}  // namespace ensonify::cli
