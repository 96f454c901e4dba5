#include "app/settings/scene_file_edit.hpp"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <optional>
#include <sstream>
#include <vector>

#include "app/settings/parameters.hpp"
#include "catchlight/error.hpp"
#include "catchlight/util/pending_file.hpp"
#include "catchlight/util/text.hpp"
#include "toml++/toml.h"

namespace catchlight::app {
namespace {

/// A key of the file: its words, and which element is meant of those that may be several.
struct Key {
  std::vector<std::string> words;
  std::size_t index = 0;
};

/// The text of a file that is edited, and what it says.
class SceneText {
 public:
  SceneText(std::string text, const std::string& path) : text_(std::move(text)), path_(path) { parse(); }

  const std::string& text() const { return text_; }

  void put(const Key& key, const std::string& literal);
  void erase(const Key& key);

 private:
  /// Where a node is in the text.
  struct Range {
    std::size_t begin, end;
  };

  void parse() {
    try {
      root_ = toml::parse(text_, path_);
    } catch (const toml::parse_error& error) {
      throw Error(path_ + ':' + std::to_string(error.source().begin.line) + ':' + std::to_string(error.source().begin.column) +
                  ": " + std::string(error.description()));
    }
  }

  void replace(const Range& range, const std::string& by) {
    text_.replace(range.begin, range.end - range.begin, by);
    parse();
  }

  std::size_t line_start(std::size_t line) const {
    std::size_t at = 0;
    for (; line > 1 && at < text_.size(); --line) {
      const std::size_t newline = text_.find('\n', at);
      at = newline == std::string::npos ? text_.size() : newline + 1;
    }
    return at;
  }

  /// Columns count characters, not bytes.
  std::size_t offset(const toml::source_position& position) const {
    std::size_t at = line_start(position.line);
    const auto goes_on = [&] { return at < text_.size() && (static_cast<unsigned char>(text_[at]) & 0xc0) == 0x80; };
    for (std::size_t column = 1; column < position.column && at < text_.size(); ++column)
      for (++at; goes_on();) ++at;
    return at;
  }

  Range range_of(const toml::node& node) const { return {offset(node.source().begin), offset(node.source().end)}; }

  /// The node of the first `count` words; null where there is none.
  toml::node* find(const Key& key, std::size_t count) {
    toml::node* node = &root_;
    for (std::size_t i = 0; i < count && node; ++i) {
      toml::table* table = node->as_table();
      node = table ? table->get(key.words[i]) : nullptr;
      if (toml::array* several = node ? node->as_array() : nullptr; several && several->is_array_of_tables())
        node = several->get(key.index);
    }
    return node;
  }

  void put_into_inline_table(const toml::table& table, const std::string& entry);
  void put_into_section(const toml::table& table, const std::string& entry);
  void put_at_the_end(const Key& key, const std::string& literal);

  std::string text_, path_;
  toml::table root_;
};

/// `a = 1`, `b = { c = 1 }`: the words from `first` on.
std::string entry_of(const Key& key, std::size_t first, const std::string& literal) {
  std::string entry = literal;
  for (std::size_t i = key.words.size(); i-- > first;)
    entry = key.words[i] + " = " + (i + 1 < key.words.size() ? "{ " + entry + " }" : entry);
  return entry;
}

void SceneText::put_into_inline_table(const toml::table& table, const std::string& entry) {
  const std::size_t close = text_.rfind('}', range_of(table).end - 1);
  const std::size_t last = text_.find_last_not_of(" \t", close - 1) + 1;
  replace({last, close}, (table.empty() ? " " : ", ") + entry + " ");
}

/// After the last line of the section's own entries.
void SceneText::put_into_section(const toml::table& table, const std::string& entry) {
  std::size_t line = table.source().begin.line;
  for (const auto& [name, node] : table) {
    const toml::table* inner = node.as_table();
    const toml::array* list = node.as_array();
    if ((inner && !inner->is_inline()) || (list && list->is_array_of_tables())) continue;
    line = std::max<std::size_t>(line, node.source().end.line);
  }
  const std::size_t at = line_start(line + 1);
  const bool ends_line = at > 0 && text_[at - 1] == '\n';
  replace({at, at}, (ends_line ? "" : "\n") + entry + "\n");
}

void SceneText::put_at_the_end(const Key& key, const std::string& literal) {
  if (key.words.size() == 1) {  // before the first section: after one it would belong to that
    const std::size_t section = text_.starts_with('[') ? 0 : text_.find("\n[");
    const std::size_t at = section == std::string::npos ? text_.size() : section == 0 ? 0 : section + 1;
    return replace({at, at}, entry_of(key, 0, literal) + "\n" + (at < text_.size() ? "\n" : ""));
  }
  const std::string gap = text_.empty() ? "" : text_.ends_with('\n') ? "\n" : "\n\n";
  replace({text_.size(), text_.size()}, gap + '[' + key.words[0] + "]\n" + entry_of(key, 1, literal) + "\n");
}

void SceneText::put(const Key& key, const std::string& literal) {
  if (const toml::node* node = find(key, key.words.size())) return replace(range_of(*node), literal);
  for (std::size_t count = key.words.size() - 1; count > 0; --count) {
    const toml::node* node = find(key, count);
    const toml::table* table = node ? node->as_table() : nullptr;
    if (!table) continue;
    const std::string entry = entry_of(key, count, literal);
    return table->is_inline() ? put_into_inline_table(*table, entry) : put_into_section(*table, entry);
  }
  put_at_the_end(key, literal);
}

void SceneText::erase(const Key& key) {
  const toml::node* node = find(key, key.words.size());
  if (!node) return;
  const Range value = range_of(*node);
  const toml::node* parent = find(key, key.words.size() - 1);
  const toml::table* table = parent ? parent->as_table() : nullptr;
  if (table && table->is_inline() && table->size() > 1) {
    const std::size_t before = text_.find_last_of("{,", value.begin);
    const bool is_first = text_[before] == '{';
    const std::size_t end = is_first ? text_.find(',', value.end) + 1 : value.end;
    return replace({is_first ? before + 1 : before, end}, "");
  }
  const toml::node& whole = table && table->is_inline() ? *parent : *node;
  const std::size_t begin = line_start(whole.source().begin.line);
  replace({begin, line_start(whole.source().end.line + 1)}, "");
}

std::string toml_text(const std::string& text) {
  std::string result = "\"";
  for (const char c : text) result += c == '"' || c == '\\' ? std::string("\\") + c : std::string(1, c);
  return result + '"';
}

/// Files beside the scene file or below it are named from there, so that the folder can be moved.
std::string path_text(const SceneSettings& settings, const std::string& text) {
  const std::filesystem::path path(text);
  if (path.is_relative() || settings.folder.empty()) return text;
  const std::filesystem::path folder = std::filesystem::absolute(settings.folder).lexically_normal();
  const std::string from_folder = path.lexically_normal().lexically_relative(folder).string();
  return from_folder.empty() || from_folder.starts_with("..") ? text : from_folder;
}

/// A value as TOML writes it.
std::string literal_of(const SceneSettings& settings, const Parameter& parameter, std::size_t index) {
  std::string text = parameter_text(settings, parameter, index);
  if (std::holds_alternative<PathKind>(parameter.kind)) text = path_text(settings, text);
  if (std::holds_alternative<VectorKind>(parameter.kind)) {
    std::string list;
    for (const std::string& component : split(text, ',')) list += (list.empty() ? "" : ", ") + component;
    return '[' + list + ']';
  }
  const bool is_word = std::holds_alternative<PathKind>(parameter.kind) || std::holds_alternative<WordKind>(parameter.kind) ||
                       std::holds_alternative<ChoiceKind>(parameter.kind) || text == "auto";
  return is_word ? toml_text(text) : text;
}

}  // namespace

std::string edited_scene_text(const std::string& text, const std::string& path, const SceneSettings& before,
                              const SceneSettings& after) {
  SceneText scene(text, path);
  for (std::size_t i = 0; i < std::min(before.objects.size(), after.objects.size()); ++i)
    if (before.objects[i].matrix && !after.objects[i].matrix) scene.erase({{"object", "tag_from_object", "matrix"}, i});
  for (const Parameter& parameter : parameters())
    for (std::size_t i = 0; i < element_count(after, parameter); ++i) {
      const Key key{split(parameter.key, '.'), i};
      // Which of several elements were given is not known: those that are as before stay as they are.
      const bool is_one = element_count(after, parameter) == 1;
      const bool was_given = !is_one || before.is_by_hand(parameter.key), is_given = !is_one || after.is_by_hand(parameter.key);
      if (was_given && !is_given) scene.erase(key);
      if (is_given && (!was_given || parameter_text(before, parameter, i) != parameter_text(after, parameter, i)))
        scene.put(key, literal_of(after, parameter, i));
    }
  return scene.text();
}

namespace {

void check_target(const std::filesystem::path& to) {
  constexpr auto kWrite =
      std::filesystem::perms::owner_write | std::filesystem::perms::group_write | std::filesystem::perms::others_write;
  std::error_code missing;
  const std::filesystem::file_status status = std::filesystem::status(to, missing);
  if (exists(status) && (status.permissions() & kWrite) == std::filesystem::perms::none)
    throw Error(to.string() + ": is write-protected; make it writable, or save under another name");
}

}  // namespace

void save_scene_file(const std::string& from, const std::string& to, const SceneSettings& before, const SceneSettings& after) {
  check_target(to);
  std::ifstream file(from, std::ios::binary);
  std::ostringstream text;
  if (file) text << file.rdbuf();
  const std::string edited = edited_scene_text(text.str(), from, before, after);
  PendingFile pending(to);
  std::ofstream out(pending.pending_path(), std::ios::binary);
  out << edited;
  out.close();
  if (!out) throw Error(to + ": cannot be written; is the disk full?");
  pending.commit();
}

}  // namespace catchlight::app
