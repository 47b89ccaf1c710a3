#pragma once

#include <stdexcept>
#include <string>

namespace ensonify {

/// Base of everything this library throws. The message says what, where, the rule and the cure.
class Error : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Wrong usage: an argument or a configuration value breaks its rule. The program exits with 2.
class ConfigError : public Error {
 public:
  using Error::Error;
};

/// The work failed on data: a broken file, a full disk. The program exits with 1.
class DataError : public Error {
 public:
  using Error::Error;
};

}  // namespace ensonify
