#include "app/tools/replay/expected.hpp"

#include <toml++/toml.h>
#include <cmath>
#include <optional>
#include <set>
#include <sstream>

#include "app/settings/toml_problem.hpp"
#include "app/support/output_file.hpp"
#include "catchlight/error.hpp"

namespace catchlight::app {

namespace {

std::string number(double value) {
  std::ostringstream text;
  text.precision(5);
  text << value;
  return text.str();
}

[[noreturn]] void fail(const std::string& path, const toml::source_region& where, const std::string& what) {
  throw Error(path + ":" + std::to_string(where.begin.line) + ": " + what +
              "; `catchlight replay --bless` writes this file anew");
}

}  // namespace

ExpectedFigures read_expected(const std::string& path) {
  ExpectedFigures figures;
  toml::table file;
  try {
    file = toml::parse_file(path);
  } catch (const toml::parse_error& error) {
    fail(path, error.source(), toml_problem(error.description()));
  }
  for (const auto& [table_name, node] : file) {
    const toml::table* table = node.as_table();
    if (!table) fail(path, node.source(), "expected tables of figures");
    for (const auto& [name, figure] : *table) {
      const std::optional<double> value = figure.value<double>();
      if (!value || !std::isfinite(*value)) fail(path, figure.source(), "expected a number for " + std::string(name.str()));
      figures[std::string(table_name.str()) + "." + std::string(name.str())] = *value;
    }
  }
  return figures;
}

void write_expected(const std::string& path, const std::vector<Figure>& figures) {
  std::ostringstream text;
  text << "# What `catchlight replay` measured here when it was last blessed (`--bless` rewrites this file).\n"
          "# Pictures: display-coded errors of 255 against truth/ (PSNR in dB), or baseline/ where no truth is known.\n"
          "# Poses: against poses.csv, or baseline/track.csv.\n";
  std::string table;
  for (const Figure& figure : figures) {
    const std::size_t dot = figure.key.find('.');
    if (figure.key.substr(0, dot) != table) {
      table = figure.key.substr(0, dot);
      text << "\n[" << table << "]\n";
    }
    text << figure.key.substr(dot + 1) << " = " << number(figure.value) << "\n";
  }
  write_text_file(path, text.str(), true);
}

std::vector<std::string> drift(const std::vector<Figure>& figures, const ExpectedFigures& expected) {
  std::vector<std::string> lines;
  std::set<std::string> measured;
  for (const Figure& figure : figures) {
    measured.insert(figure.key);
    const auto wanted = expected.find(figure.key);
    if (wanted == expected.end())
      lines.push_back(figure.key + " = " + number(figure.value) + ", no figure expected");
    else if (!(std::abs(figure.value - wanted->second) <= figure.tolerance))
      lines.push_back(figure.key + " = " + number(figure.value) + ", expected " + number(wanted->second) + " +- " +
                      number(figure.tolerance));
  }
  for (const auto& [key, value] : expected)
    if (!measured.contains(key)) lines.push_back(key + " expected to be " + number(value) + ", not measured");
  return lines;
}

}  // namespace catchlight::app
