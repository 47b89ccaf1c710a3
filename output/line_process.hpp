#pragma once

#include <sys/types.h>

#include <functional>
#include <string>
#include <string_view>

namespace ensonify {

/// A program that is talked to in lines: one to its standard input, one back from its standard output. Its standard
/// error is ours. It runs in a process group of its own, which ends with this object: its input is closed, and what
/// still runs after a second is killed.
class LineProcess {
 public:
  /// Runs `command` by /bin/sh. `stop` is asked ten times a second while we wait; true ends the waiting by an error.
  /// Throws DataError where no process can be started.
  LineProcess(std::string command, std::function<bool()> stop);
  ~LineProcess();
  LineProcess(const LineProcess&) = delete;
  LineProcess& operator=(const LineProcess&) = delete;

  /// Writes the line and a newline. Throws DataError where the program has ended or does not read it in time.
  void say(std::string_view line, double timeout_s);
  /// The next line, without its newline. Throws DataError where the program has ended, does not say one in time, or one
  /// longer than 1 MiB.
  std::string hear(double timeout_s);

 private:
  bool ended(double within_s) const;
  [[noreturn]] void fail(const std::string& what) const;
  void wait_for(int file, short event, double until_s, double timeout_s, const char* what) const;

  std::string command_;
  std::function<bool()> stop_;
  pid_t child_ = -1;
  int to_ = -1;
  int from_ = -1;
  std::string heard_;  ///< bytes beyond the last line
};

}  // namespace ensonify
