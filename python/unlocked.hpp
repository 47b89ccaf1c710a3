#pragma once

#include <optional>

#include "ensonify/python/bindings.hpp"

/// The interpreter's lock, also where the interpreter ends while threads compute. CPython before 3.14 unwinds a thread
/// that then asks for the lock, which kills the process where C++ is on the stack. So once it ends no thread gets the
/// lock back: what computes is waited for, and its thread sleeps until the process is over.
namespace ensonify::python {

class Ending;

/// The lock is let go while it lives. Made with the lock.
class Unlocked {
 public:
  Unlocked();
  ~Unlocked();
  Unlocked(const Unlocked&) = delete;
  Unlocked& operator=(const Unlocked&) = delete;

 private:
  void sleep_if_barred();

  Ending* ending_;
  std::optional<py::gil_scoped_release> released_;
};

/// The lock is taken again while it lives, for calls of the user's functions. Throws std::runtime_error where the
/// interpreter ends, so that the work around it ends too.
class Locked {
 public:
  Locked();
  ~Locked();
  Locked(const Locked&) = delete;
  Locked& operator=(const Locked&) = delete;

 private:
  Ending* ending_;
  std::optional<py::gil_scoped_acquire> locked_;
};

/// Called with the lock before the interpreter ends. Waits for what computes, but for the user's functions in it no
/// longer than 2 s.
void end_unlocked();

}  // namespace ensonify::python
