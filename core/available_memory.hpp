#pragma once

#include <cstddef>

namespace ensonify {

/// Bytes that a program can take without driving others out: MemAvailable of Linux, elsewhere all physical memory.
/// Limits of containers are not known here.
std::size_t available_memory_bytes();

}  // namespace ensonify
