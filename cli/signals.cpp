#include "ensonify/cli/signals.hpp"

#include <csignal>

namespace ensonify::cli {
namespace {

// A signal handler reaches nothing but a variable of this kind.
volatile std::sig_atomic_t caught = 0;

void take(int signal) {
  caught = signal;
  std::signal(signal, SIG_DFL);
}

}  // namespace

void watch_signals() {
  std::signal(SIGINT, take);
  std::signal(SIGTERM, take);
}

int caught_signal() { return caught; }

}  // namespace ensonify::cli
