// Values, lists and maps of a text file as YAML, JSON and OpenCV's XML have them. Private to tracking/camera.
#pragma once

#include <string>
#include <utility>
#include <vector>

namespace catchlight::tracking {

struct TextNode {
  enum class Kind { value, list, map };
  Kind kind = Kind::value;
  std::string text;               ///< of a value
  std::vector<TextNode> items;    ///< of a list; of a map as many as keys
  std::vector<std::string> keys;  ///< of a map

  /// The member of that name; null where there is none, or where this is no map.
  const TextNode* find(const std::string& key) const;
};

/// Reads the first document of a YAML file (OpenCV's "%YAML:1.0" too), JSON, or OpenCV's XML. Throws Error that names the file,
/// and the line where the text is wrong; NumPy's own formats are named as such.
TextNode read_text_tree(const std::string& path);

}  // namespace catchlight::tracking
