// What is thrown for bad input, and how libraries reach the user: they never print.
#pragma once

#include <functional>
#include <stdexcept>
#include <string>

namespace catchlight {

/// Bad input or environment: the message names the file, line or option, what was expected and what to do. Exit code 1.
struct Error : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// A command line that cannot be carried out. Exit code 2.
struct UsageError : Error {
  using Error::Error;
};

/// Receives one warning for the user; libraries never print.
using WarningHandler = std::function<void(const std::string&)>;

}  // namespace catchlight
