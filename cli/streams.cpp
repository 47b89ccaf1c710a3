#include "ensonify/cli/streams.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <fmt/ostream.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <iostream>

namespace ensonify::cli {

void hold_standard_streams() {
  for (const int stream : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) {
    // The lowest free number is taken. Read-only: what is printed fails, and is told of.
    if (::fcntl(stream, F_GETFD) < 0) static_cast<void>(::open("/dev/null", O_RDONLY));
  }
}

int finish_standard_output(int code) {
  errno = 0;
  const bool taken = std::fflush(stdout) == 0 && std::ferror(stdout) == 0;
  if (taken || errno == EPIPE) return code;
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
