#pragma once

#include <atomic>
#include <chrono>
#include <exception>
#include <future>

#include "ensonify/python/bindings.hpp"
#include "ensonify/python/unlocked.hpp"

namespace ensonify::python {

/// Runs work(stopped) on a thread of its own while this one, without the interpreter's lock, looks for signals: Ctrl-C
/// sets `stopped`, and once the work has come to an end its exception (KeyboardInterrupt) is raised. `meanwhile` is
/// called now and then with the lock.
template <typename Work, typename Meanwhile>
auto interruptible(const Work& work, const Meanwhile& meanwhile) {
  const Unlocked unlocked;
  std::atomic<bool> stopped = false;
  auto result = std::async(std::launch::async, [&] { return work(stopped); });
  std::exception_ptr raised;
  constexpr std::chrono::milliseconds patience{50};
  for (bool done = false; !done;) {
    done = result.wait_for(patience) == std::future_status::ready;
    if (raised) continue;
    try {
      const Locked locked;
      if (PyErr_CheckSignals() != 0) throw py::error_already_set();
      meanwhile();
    } catch (...) {
      raised = std::current_exception();
      stopped = true;
    }
  }
  if (raised) std::rethrow_exception(raised);
  return result.get();
}

}  // namespace ensonify::python
