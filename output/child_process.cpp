#include "ensonify/output/child_process.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <signal.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>

#include "ensonify/core/error.hpp"

extern char** environ;

namespace ensonify {
namespace {

struct Pipe {
  std::array<int, 2> ends{-1, -1};
  Pipe() {
    if (pipe2(ends.data(), O_CLOEXEC) != 0) throw DataError(fmt::format("no pipe: {}", std::strerror(errno)));
  }
  ~Pipe() { close_end(0), close_end(1); }
  Pipe(const Pipe&) = delete;
  Pipe& operator=(const Pipe&) = delete;
  void close_end(std::size_t i) {
    if (ends[i] >= 0) close(ends[i]);
    ends[i] = -1;
  }
};

pid_t start(const std::vector<std::string>& words, const Pipe& in, const Pipe& out, const Pipe& error) {
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_adddup2(&actions, in.ends[0], STDIN_FILENO);
  posix_spawn_file_actions_adddup2(&actions, out.ends[1], STDOUT_FILENO);
  posix_spawn_file_actions_adddup2(&actions, error.ends[1], STDERR_FILENO);
  std::vector<char*> argv;
  for (const std::string& word : words) argv.push_back(const_cast<char*>(word.c_str()));
  argv.push_back(nullptr);
  pid_t child = -1;
  const int failed = posix_spawnp(&child, argv[0], &actions, nullptr, argv.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  return failed == 0 ? child : -1;
}

/// Moves what can be moved until both outputs are at their end.
void converse(std::span<const std::uint8_t> input, Pipe& in, Pipe& out, Pipe& error, std::vector<std::uint8_t>& said,
              std::string& complaint) {
  fcntl(in.ends[1], F_SETFL, O_NONBLOCK);
  std::array<char, 65536> buffer{};
  while (out.ends[0] >= 0 || error.ends[0] >= 0) {
    std::array<pollfd, 3> waits{pollfd{in.ends[1], POLLOUT, 0}, pollfd{out.ends[0], POLLIN, 0},
                                pollfd{error.ends[0], POLLIN, 0}};
    if (poll(waits.data(), waits.size(), -1) < 0 && errno != EINTR) return;
    if (waits[0].revents != 0) {
      const ssize_t n = write(in.ends[1], input.data(), input.size());
      if (n >= 0) input = input.subspan(static_cast<std::size_t>(n));
      if (input.empty() || (n < 0 && errno != EAGAIN && errno != EINTR)) in.close_end(1);
    }
    if (waits[1].revents != 0) {
      const ssize_t n = read(out.ends[0], buffer.data(), buffer.size());
      if (n > 0) said.insert(said.end(), buffer.data(), buffer.data() + n);
      if (n == 0 || (n < 0 && errno != EINTR)) out.close_end(0);
    }
    if (waits[2].revents != 0) {
      const ssize_t n = read(error.ends[0], buffer.data(), buffer.size());
      if (n > 0 && complaint.size() < 4096) complaint.append(buffer.data(), static_cast<std::size_t>(n));
      if (n == 0 || (n < 0 && errno != EINTR)) error.close_end(0);
    }
  }
}

/// A program that ends before it has read all must not end this one.
class IgnoreBrokenPipe {
 public:
  IgnoreBrokenPipe() {
    sigset_t pipe;
    sigemptyset(&pipe);
    sigaddset(&pipe, SIGPIPE);
    pthread_sigmask(SIG_BLOCK, &pipe, &before_);
  }
  ~IgnoreBrokenPipe() {
    sigset_t pipe;
    sigemptyset(&pipe);
    sigaddset(&pipe, SIGPIPE);
    const timespec now{};
    while (sigtimedwait(&pipe, nullptr, &now) > 0) {
    }
    pthread_sigmask(SIG_SETMASK, &before_, nullptr);
  }

 private:
  sigset_t before_{};
};

}  // namespace

std::vector<std::uint8_t> run_program(const std::vector<std::string>& words, std::span<const std::uint8_t> input,
                                      const std::string& cure) {
  Pipe in, out, error;
  const pid_t child = start(words, in, out, error);
  if (child < 0) throw DataError(fmt::format("{} can not be started; {}", words[0], cure));
  in.close_end(0), out.close_end(1), error.close_end(1);
  const IgnoreBrokenPipe ignore;
  std::vector<std::uint8_t> said;
  std::string complaint;
  converse(input, in, out, error, said, complaint);
  in.close_end(1);
  int status = 0;
  while (waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  if (!WIFEXITED(status) || WEXITSTATUS(status) != 0 || said.empty()) {
    throw DataError(fmt::format("{} failed{}{}; {}", words[0], complaint.empty() ? "" : ": ", complaint, cure));
  }
  return said;
}

}  // namespace ensonify
