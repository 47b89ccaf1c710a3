#include "ensonify/output/line_process.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <signal.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <thread>

#include "ensonify/core/error.hpp"

extern char** environ;

namespace ensonify {
namespace {

constexpr std::size_t longest_line = std::size_t{1} << 20;
constexpr double grace_s = 1.0;

double now_s() { return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count(); }

void close_file(int& file) {
  if (file >= 0) close(file);
  file = -1;
}

/// What we ignore or catch, it shall not inherit.
pid_t spawn_shell(const std::string& command, int input, int output) {
  posix_spawn_file_actions_t actions;
  posix_spawnattr_t attributes;
  posix_spawn_file_actions_init(&actions);
  posix_spawnattr_init(&attributes);
  posix_spawn_file_actions_adddup2(&actions, input, STDIN_FILENO);
  posix_spawn_file_actions_adddup2(&actions, output, STDOUT_FILENO);
  sigset_t ours;
  sigemptyset(&ours);
  for (const int signal : {SIGPIPE, SIGXFSZ, SIGINT, SIGTERM}) sigaddset(&ours, signal);
  posix_spawnattr_setsigdefault(&attributes, &ours);
  posix_spawnattr_setpgroup(&attributes, 0);
  posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETPGROUP | POSIX_SPAWN_SETSIGDEF);
  std::string shell = "/bin/sh", option = "-c", text = command;
  std::array<char*, 4> argv{shell.data(), option.data(), text.data(), nullptr};
  pid_t child = -1;
  const int failed = posix_spawn(&child, shell.c_str(), &actions, &attributes, argv.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  posix_spawnattr_destroy(&attributes);
  return failed == 0 ? child : -1;
}

}  // namespace

LineProcess::LineProcess(std::string command, std::function<bool()> stop)
    : command_(std::move(command)), stop_(std::move(stop)) {
  std::array<int, 2> in{-1, -1};
  std::array<int, 2> out{-1, -1};
  if (pipe2(in.data(), O_CLOEXEC) == 0 && pipe2(out.data(), O_CLOEXEC) == 0) {
    child_ = spawn_shell(command_, in[0], out[1]);
  }
  close_file(in[0]), close_file(out[1]);
  to_ = in[1], from_ = out[0];
  if (child_ < 0) {
    close_file(to_), close_file(from_);
    fail("can not be started");
  }
  fcntl(to_, F_SETFL, O_NONBLOCK);
  fcntl(from_, F_SETFL, O_NONBLOCK);
}

LineProcess::~LineProcess() {
  if (child_ < 0) return;
  close_file(to_);
  ended(stop_ && stop_() ? 0.0 : grace_s);
  // The group before its leader is reaped: until then no other process can have its number.
  kill(-child_, SIGKILL);
  int status = 0;
  while (waitpid(child_, &status, 0) < 0 && errno == EINTR) {
  }
  close_file(from_);
}

bool LineProcess::ended(double within_s) const {
  const double until = now_s() + within_s;
  for (;;) {
    siginfo_t info{};
    if (waitid(P_PID, static_cast<id_t>(child_), &info, WEXITED | WNOHANG | WNOWAIT) == 0 && info.si_pid != 0)
      return true;
    if (now_s() >= until) return false;
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
}

void LineProcess::fail(const std::string& what) const {
  throw DataError(fmt::format("plug-in \"{}\": {}", command_, what));
}

void LineProcess::wait_for(int file, short event, double until_s, double timeout_s, const char* what) const {
  for (;;) {
    if (stop_ && stop_()) fail("stopped");
    const double left_s = until_s - now_s();
    if (left_s <= 0) fail(fmt::format("{} within {} s; give it more by --plugin-timeout", what, timeout_s));
    pollfd waits{file, event, 0};
    const int ready = poll(&waits, 1, std::max(1, static_cast<int>(1000 * std::min(left_s, 0.1))));
    if (ready > 0) return;
    if (ready < 0 && errno != EINTR) fail(std::strerror(errno));
  }
}

void LineProcess::say(std::string_view line, double timeout_s) {
  const std::string text = std::string(line) + '\n';
  std::string_view rest = text;
  const double until_s = now_s() + timeout_s;
  while (!rest.empty()) {
    wait_for(to_, POLLOUT, until_s, timeout_s, "did not read its input");
    const ssize_t n = write(to_, rest.data(), rest.size());
    if (n >= 0)
      rest.remove_prefix(static_cast<std::size_t>(n));
    else if (errno != EAGAIN && errno != EINTR)
      fail(ended(grace_s) ? "has ended before the run" : "has closed its input");
  }
}

std::string LineProcess::hear(double timeout_s) {
  const double until_s = now_s() + timeout_s;
  std::array<char, 65536> buffer{};
  for (;;) {
    if (const auto end = heard_.find('\n'); end != std::string::npos) {
      std::string line = heard_.substr(0, end);
      heard_.erase(0, end + 1);
      return line;
    }
    if (heard_.size() > longest_line) fail("said a line longer than 1 MiB");
    wait_for(from_, POLLIN, until_s, timeout_s, "did not answer");
    const ssize_t n = read(from_, buffer.data(), buffer.size());
    if (n > 0) heard_.append(buffer.data(), static_cast<std::size_t>(n));
    if (n == 0) fail(ended(grace_s) ? "ended instead of answering" : "closed its output instead of answering");
    if (n < 0 && errno != EAGAIN && errno != EINTR) fail(std::strerror(errno));
  }
}

}  // namespace ensonify
