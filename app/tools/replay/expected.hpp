// expected.toml: the figures a recording is held against.
#pragma once

#include <map>
#include <string>
#include <vector>

namespace catchlight::app {

/// One measured figure. `key` is table.name in expected.toml.
struct Figure {
  std::string key;
  double value;
  double tolerance;  ///< how far it may lie from the expected value, either way: better is drift too, and is blessed
};

using ExpectedFigures = std::map<std::string, double>;

/// Throws Error with file:line for what is not TOML or not a number.
ExpectedFigures read_expected(const std::string& path);

/// Rewrites the file.
void write_expected(const std::string& path, const std::vector<Figure>& figures);

/// One line for each figure that is out of tolerance, missing in `expected`, or expected and not measured. Empty: all as
/// expected.
std::vector<std::string> drift(const std::vector<Figure>& figures, const ExpectedFigures& expected);

}  // namespace catchlight::app
