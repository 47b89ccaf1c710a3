#include "ensonify/cli/streams.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <fmt/ostream.h>
#include <poll.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <iostream>

namespace ensonify::cli {
namespace {

/// Nobody reads standard output any more: it is a pipe, closed at its other end.
bool reader_is_gone() {
  pollfd out{STDOUT_FILENO, POLLOUT, 0};
  return ::poll(&out, 1, 0) > 0 && (out.revents & POLLERR) != 0;
}

}  // namespace

void hold_standard_streams() {
  for (const int stream : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) {
    // The lowest free number is taken. Read-only: what is printed fails, and is told of.
    if (::fcntl(stream, F_GETFD) < 0) static_cast<void>(::open("/dev/null", O_RDONLY));
  }
}

int finish_standard_output(int code) {
  errno = 0;
  const bool taken = std::fflush(stdout) == 0 && std::ferror(stdout) == 0;
  // An error from before this flush has left no errno.
  if (taken || errno == EPIPE || (errno == 0 && reader_is_gone())) return code;
  complain(fmt::format("standard output: can not be written{}{}", errno != 0 ? ": " : "",
                       errno != 0 ? std::strerror(errno) : ""));
  return code == 0 ? 1 : code;
}

void complain(const std::string& message) {
  constexpr std::size_t longest = 2000;
  std::string text = message.size() <= longest ? message : message.substr(0, longest) + " ...";
  for (char& c : text) {
    const auto byte = static_cast<unsigned char>(c);
    if ((byte < ' ' && c != '\n') || byte == 127) c = '?';
  }
  fmt::print(std::cerr, "ensonify: {}\n", text);
}

}  // namespace ensonify::cli
