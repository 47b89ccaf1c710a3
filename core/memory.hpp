#pragma once

#ifdef __GLIBC__
#include <malloc.h>
#endif

namespace ensonify {

/// For programs that make many pings, and for the Python module: lets the heap keep the pages of images that come and
/// go. Otherwise every image of a megabyte is mapped, cleared by the kernel and unmapped again, a seventh of a ping's
/// time. Does nothing without glibc.
inline void keep_freed_pages() {
#ifdef __GLIBC__
  constexpr int larger_than_any_image = 256 << 20;
  mallopt(M_MMAP_THRESHOLD, larger_than_any_image);
  mallopt(M_TRIM_THRESHOLD, larger_than_any_image);
#endif
}

}  // namespace ensonify
