#include "app/commands/help.hpp"

#include "catchlight/util/text.hpp"

namespace catchlight::app {
namespace {

/// Lines of at most `columns`, broken at spaces; a longer word stays whole.
std::string wrapped(const std::string& text, std::size_t columns) {
  std::string result;
  std::size_t used = 0;
  for (const std::string& line : split(text, '\n')) {
    if (!result.empty()) result += '\n';
    used = 0;
    for (const std::string& word : split(line, ' ')) {
      const bool fits = used + 1 + word.size() <= columns;
      if (used > 0) result += fits ? ' ' : '\n';
      used = used > 0 && fits ? used + 1 + word.size() : word.size();
      result += word;
    }
  }
  return result;
}

}  // namespace

std::string HelpFormatter::make_option_desc(const CLI::Option* option) const {
  return wrapped(option->get_description(), kMaxColumns - get_column_width());
}

std::string parameter_help(const Parameter& parameter) {
  const std::string held = parameter_text(SceneSettings{}, parameter);
  return parameter.help + "\n[" + expected_text(parameter) + "; default " + (held.empty() ? "none" : held) + ']';
}

void show_examples(CLI::App& command, std::initializer_list<const char*> examples) {
  std::string text = "Examples:\n";
  for (const char* example : examples) text += std::string("  ") + example + '\n';
  const std::string footer = command.get_footer();
  command.footer(footer.empty() ? text : text + '\n' + footer);
}

std::vector<std::string> with_help_as_option(std::vector<std::string> arguments) {
  if (arguments.empty() || arguments.front() != "help") return arguments;
  arguments.erase(arguments.begin());
  arguments.emplace_back("--help");
  return arguments;
}

}  // namespace catchlight::app
