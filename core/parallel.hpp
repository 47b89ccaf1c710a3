#pragma once

#include <tbb/parallel_for.h>

namespace ensonify {

/// Calls body(i) for i in [0, n) on the threads of the current oneTBB arena. Every i must write its own output only,
/// so that the result does not depend on the number of threads.
template <typename Body>
void parallel_for(int n, const Body& body) {
  tbb::parallel_for(0, n, body);
}

}  // namespace ensonify
