#include "app/settings/scene_file.hpp"

#include <filesystem>
#include <fstream>
#include <sstream>

#include "app/settings/parameters.hpp"
#include "app/settings/toml_problem.hpp"
#include "catchlight/error.hpp"
#include "catchlight/util/text.hpp"
#include "toml++/toml.h"

namespace catchlight::app {
namespace {

constexpr const char* kMatrixKey = "object.tag_from_object.matrix";

std::string read_text(const std::string& path) {
  if (std::filesystem::is_directory(path)) throw Error(path + ": is a folder; expected a scene file (TOML)");
  std::ifstream file(path, std::ios::binary);
  if (!file) throw Error(path + ": cannot open the scene file; does it exist, and may it be read?");
  std::ostringstream text;
  text << file.rdbuf();
  return text.str();
}

/// Every name a key may have: parameters and the tables around them.
std::vector<std::string> known_names() {
  std::vector<std::string> names{kMatrixKey};
  for (const Parameter& parameter : parameters()) {
    names.push_back(parameter.key);
    for (std::size_t dot = parameter.key.find('.'); dot != std::string::npos; dot = parameter.key.find('.', dot + 1)) {
      const std::string table = parameter.key.substr(0, dot);
      if (std::find(names.begin(), names.end(), table) == names.end()) names.push_back(table);
    }
  }
  return names;
}

class Reader {
 public:
  Reader(std::string path, SceneSettings& settings) : path_(std::move(path)), settings_(settings), names_(known_names()) {}

  void read(const toml::table& root) {
    for (const auto& [key, node] : root) {
      if (key.str() == "object")
        read_objects(node);
      else
        read_entry("", 0, key, node);
    }
  }

 private:
  [[noreturn]] void fail(const toml::source_region& where, const std::string& message) const {
    throw Error(path_ + ':' + std::to_string(where.begin.line) + ':' + std::to_string(where.begin.column) + ": " + message);
  }

  void read_objects(const toml::node& node) {
    const toml::array* objects = node.as_array();
    if (!objects || !objects->is_array_of_tables())
      fail(node.source(), "expected [[object]], in double brackets, once for each object");
    for (const toml::node& object : *objects) {
      settings_.objects.emplace_back();
      read_table("object.", settings_.objects.size() - 1, *object.as_table());
      if (settings_.objects.back().mesh.empty()) fail(object.source(), "this [[object]] has no mesh; give `mesh = \"FILE\"`");
    }
  }

  void read_bundle(const toml::node& node) {
    const toml::array* tags = node.as_array();
    if (!tags || !tags->is_array_of_tables())
      fail(node.source(), "expected [[tag.bundle]], in double brackets, once for each further tag of the board");
    for (const toml::node& tag : *tags) {
      settings_.tag.bundle.emplace_back();
      read_table("tag.bundle.", settings_.tag.bundle.size() - 1, *tag.as_table());
      if (!tag.as_table()->contains("id")) fail(tag.source(), "this [[tag.bundle]] has no id; give `id = NUMBER`");
    }
  }

  /// `index` is that of the object or further tag that the table describes.
  void read_table(const std::string& prefix, std::size_t index, const toml::table& table) {
    for (const auto& [key, node] : table) read_entry(prefix, index, key, node);
  }

  void read_entry(const std::string& prefix, std::size_t index, const toml::key& key, const toml::node& node) {
    const std::string name = prefix + std::string(key.str());
    if (name == "tag.bundle") return read_bundle(node);
    if (name == kMatrixKey) return read_matrix(index, key, node);
    if (const Parameter* parameter = find_parameter(name)) return read_value(*parameter, index, node);
    if (std::find(names_.begin(), names_.end(), name) == names_.end())
      fail(key.source(), "unknown key '" + name + "'; did you mean '" + nearest(name, names_) + "'?");
    const toml::table* table = node.as_table();
    if (!table) fail(node.source(), "'" + name + "' is " + type_of(node) + "; expected a table");
    if (name == "object.tag_from_object" && table->contains("matrix") && table->size() > 1)
      fail(key.source(),
           "'" + name + "' has a matrix and more; expected either the matrix alone or translation_m, rotation_deg and scale");
    read_table(name + '.', index, *table);
  }

  static std::string type_of(const toml::node& node) {
    std::ostringstream name;
    name << node.type();
    const std::string text = name.str();
    return (text == "array" || text == "integer" ? "an " : "a ") + text;
  }

  void read_value(const Parameter& parameter, std::size_t index, const toml::node& node) {
    const std::optional<ParameterValue> value = value_of(node);
    if (!value) fail(node.source(), parameter.key + " is " + type_of(node) + "; expected " + expected_text(parameter));
    try {
      set_parameter(settings_, parameter, *value, index);
    } catch (const Error& error) {
      fail(node.source(), error.what());
    }
  }

  static std::optional<ParameterValue> value_of(const toml::node& node) {
    if (const auto* flag = node.as_boolean()) return flag->get();
    if (const auto* integer = node.as_integer()) return integer->get();
    if (const auto* real = node.as_floating_point()) return real->get();
    if (const auto* text = node.as_string()) return text->get();
    glm::dvec3 v;
    const toml::array* array = node.as_array();
    if (!array || array->size() != 3) return std::nullopt;
    for (std::size_t i = 0; i < 3; ++i) {
      if (!array->get(i)->is_number()) return std::nullopt;
      v[static_cast<int>(i)] = *array->get(i)->value<double>();
    }
    return v;
  }

  /// glm keeps columns, the file rows.
  void read_matrix(std::size_t index, const toml::key& key, const toml::node& node) {
    glm::dmat4 matrix(1.0);
    const toml::array* rows = node.as_array();
    if (!rows || rows->size() != 3) fail_matrix(key);
    for (int row = 0; row < 3; ++row) {
      const toml::array* cells = rows->get(static_cast<std::size_t>(row))->as_array();
      if (!cells || cells->size() != 4) fail_matrix(key);
      for (int column = 0; column < 4; ++column) {
        const toml::node* cell = cells->get(static_cast<std::size_t>(column));
        const std::optional<double> number = cell->is_number() ? cell->value<double>() : std::nullopt;
        if (!number || !std::isfinite(*number)) fail_matrix(key);
        matrix[column][row] = *number;
      }
    }
    settings_.objects[index].matrix = matrix;
    settings_.by_hand.insert(kMatrixKey);
  }

  [[noreturn]] void fail_matrix(const toml::key& key) const {
    fail(key.source(), std::string(kMatrixKey) + ": expected 3 rows of 4 finite numbers");
  }

  std::string path_;
  SceneSettings& settings_;
  std::vector<std::string> names_;
};

}  // namespace

SceneSettings read_scene_file(const std::string& path) {
  SceneSettings settings;
  settings.folder = std::filesystem::path(path).parent_path().string();
  const std::string text = read_text(path);
  try {
    Reader(path, settings).read(toml::parse(text, path));
  } catch (const toml::parse_error& error) {
    const auto& where = error.source().begin;
    throw Error(path + ':' + std::to_string(where.line) + ':' + std::to_string(where.column) + ": " +
                toml_problem(error.description()));
  }
  return settings;
}

}  // namespace catchlight::app
