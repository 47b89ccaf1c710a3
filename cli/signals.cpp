#include "ensonify/cli/signals.hpp"

#include <unistd.h>

#include <csignal>

#include "ensonify/cli/commands.hpp"
#include "ensonify/output/atomic_file.hpp"

namespace ensonify::cli {
namespace {

// A signal handler reaches nothing but a variable of this kind.
volatile std::sig_atomic_t caught = 0;

void end(int signal) { ::_exit(128 + signal); }

void take(int signal) {
  caught = signal;
  std::signal(signal, end);
}

void handle(void (*handler)(int)) {
  for (const int signal : {SIGINT, SIGTERM}) {
    // Who starts a program in the background may have it ignore them.
    if (std::signal(signal, handler) == SIG_IGN) std::signal(signal, SIG_IGN);
  }
}

}  // namespace

void end_at_signals() {
  handle(end);
  std::signal(SIGPIPE, SIG_IGN);
  std::signal(SIGXFSZ, SIG_IGN);
}

void watch_signals() { handle(take); }

int caught_signal() { return caught; }

void write_unbroken(const std::filesystem::path& folder, const std::function<void()>& write) {
  watch_signals();
  remove_abandoned_beside(folder.empty() ? "." : folder);
  write();
  if (caught_signal() != 0) throw ExitCode{128 + caught_signal()};
  handle(end);
}

}  // namespace ensonify::cli
