#include <CLI/CLI.hpp>
#include <cstdio>
#include <memory>

#include "app/commands/commands.hpp"
#include "app/commands/help.hpp"
#include "app/settings/parameters.hpp"

namespace catchlight::app {
namespace {

void print_table() {
  const SceneSettings defaults;
  for (const Parameter& parameter : parameters())
    std::printf("%s = %s\n    %s\n    Expected: %s.\n    A change costs: %s.\n", parameter.key.c_str(),
                parameter_text(defaults, parameter).c_str(), parameter.help.c_str(), expected_text(parameter).c_str(),
                name_of(parameter.cost).c_str());
}

}  // namespace

void set_up_params(CLI::App& command, Context&) {
  const auto markdown = std::make_shared<bool>(false);
  command.add_flag("--markdown", *markdown, "As docs/parameters.md");
  show_examples(command, {"catchlight params", "catchlight params --markdown > parameters.md"});
  command.callback([markdown] { *markdown ? (void)std::fputs(parameters_markdown().c_str(), stdout) : print_table(); });
}

}  // namespace catchlight::app
