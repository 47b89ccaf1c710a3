#pragma once

#include <unistd.h>

#include <memory>
#include <mutex>

#include "ensonify/python/bindings.hpp"
#include "ensonify/python/unlocked.hpp"

namespace ensonify::python {

/// A thing with a device behind it, made when first asked for, and once more in every forked process: the child has the
/// parent's memory, but none of the threads that its device counts on. What the child inherited is left as it is.
template <typename T>
class PerProcess {
 public:
  PerProcess() = default;
  PerProcess(const PerProcess&) = delete;
  PerProcess& operator=(const PerProcess&) = delete;
  ~PerProcess() { abandon_if_inherited(); }

  /// Called with the interpreter's lock, which is let go while `make` works. Whoever comes meanwhile waits.
  template <typename Make>
  const T& get(const Make& make) {
    abandon_if_inherited();
    const std::shared_ptr<State> state = state_;
    const Unlocked unlocked;
    std::call_once(state->made, [&] { state->value = make(); });
    return *state->value;
  }

 private:
  struct State {
    pid_t process = ::getpid();
    std::once_flag made;
    std::unique_ptr<T> value;
  };

  void abandon_if_inherited() {
    if (state_->process == ::getpid()) return;
    new std::shared_ptr<State>(std::move(state_));
    state_ = std::make_shared<State>();
  }

  std::shared_ptr<State> state_ = std::make_shared<State>();
};

}  // namespace ensonify::python
