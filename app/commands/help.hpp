// How help looks, and what stands at its end.
#pragma once

#include <CLI/CLI.hpp>
#include <initializer_list>
#include <string>
#include <vector>

#include "app/settings/parameters.hpp"

namespace catchlight::app {

/// Breaks descriptions at kMaxColumns.
class HelpFormatter : public CLI::Formatter {
 public:
  static constexpr std::size_t kMaxColumns = 100;
  std::string make_option_desc(const CLI::Option* option) const override;
};

/// What help says of a parameter: its meaning, and on a line of its own what is expected and the default.
std::string parameter_help(const Parameter& parameter);

/// Puts command lines to start from at the end of the command's help, before what its footer says already.
void show_examples(CLI::App& command, std::initializer_list<const char*> examples);

/// `help track` as `track --help`: what users of other programs type.
std::vector<std::string> with_help_as_option(std::vector<std::string> arguments);

}  // namespace catchlight::app
