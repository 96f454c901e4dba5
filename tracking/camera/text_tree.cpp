#include "tracking/camera/text_tree.hpp"

#include <yaml.h>

#include <algorithm>
#include <fstream>
#include <opencv2/core.hpp>
#include <sstream>

#include "catchlight/error.hpp"
#include "catchlight/util/text.hpp"

namespace catchlight::tracking {
namespace {

constexpr int kMaxDepth = 16;
constexpr std::size_t kMaxNodes = 1'000'000;  ///< aliases of aliases would grow without end
constexpr const char* kWhatToWrite =
    "; write lists as JSON or YAML instead, with camera_matrix.tolist() (docs/calibration.md has the lines)";

std::string text_of_file(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  if (!file) throw Error(path + ": cannot be opened; expected a camera file");
  std::ostringstream buffer;
  buffer << file.rdbuf();
  std::string text = buffer.str();
  if (text.empty()) throw Error(path + ": is empty; expected a camera file");
  if (text.starts_with("\xEF\xBB\xBF")) text.erase(0, 3);
  return text;
}

void refuse_binary(const std::string& path, const std::string& text) {
  if (text.starts_with("PK\x03\x04") || text.starts_with("\x93NUMPY") || text.starts_with("\x80"))
    throw Error(path + ": is a file of NumPy or pickle, which only Python reads" + kWhatToWrite);
  if (text.find('\0') != std::string::npos) throw Error(path + ": is no text; expected a camera file: YAML, JSON or XML");
}

class YamlReader {
 public:
  YamlReader(const std::string& path, const std::string& text) : path_(path) {
    yaml_parser_initialize(&parser_);
    yaml_parser_set_input_string(&parser_, reinterpret_cast<const unsigned char*>(text.data()), text.size());
    if (!yaml_parser_load(&parser_, &document_)) {
      const std::string what = parser_.problem ? parser_.problem : "no more is known";
      const std::string line = std::to_string(parser_.problem_mark.line + 1);
      yaml_parser_delete(&parser_);
      throw Error(path + ":" + line + ": is neither YAML nor JSON (" + what + ")");
    }
  }
  YamlReader(const YamlReader&) = delete;
  YamlReader& operator=(const YamlReader&) = delete;
  ~YamlReader() {
    yaml_document_delete(&document_);
    yaml_parser_delete(&parser_);
  }

  TextNode root() {
    const yaml_node_t* node = yaml_document_get_root_node(&document_);
    return node ? tree(*node, 0) : TextNode{};
  }

 private:
  [[noreturn]] void refuse(const yaml_node_t& node, const std::string& why) const {
    throw Error(path_ + ":" + std::to_string(node.start_mark.line + 1) + ": " + why);
  }

  const yaml_node_t& node_of(int index) { return *yaml_document_get_node(&document_, index); }

  TextNode tree(const yaml_node_t& node, int depth) {
    if (depth > kMaxDepth || ++nodes_ > kMaxNodes) refuse(node, "is nested too deeply for a camera file");
    const std::string tag = node.tag ? reinterpret_cast<const char*>(node.tag) : "";
    if (tag.find("python/object") != std::string::npos)
      refuse(node, "holds NumPy arrays as Python's yaml.dump writes them, which only Python reads" + std::string(kWhatToWrite));
    TextNode result;
    if (node.type == YAML_SCALAR_NODE) {
      result.text.assign(reinterpret_cast<const char*>(node.data.scalar.value), node.data.scalar.length);
    } else if (node.type == YAML_SEQUENCE_NODE) {
      result.kind = TextNode::Kind::list;
      for (const int* item = node.data.sequence.items.start; item != node.data.sequence.items.top; ++item)
        result.items.push_back(tree(node_of(*item), depth + 1));
    } else {
      result.kind = TextNode::Kind::map;
      for (const yaml_node_pair_t* pair = node.data.mapping.pairs.start; pair != node.data.mapping.pairs.top; ++pair) {
        result.keys.push_back(tree(node_of(pair->key), depth + 1).text);
        result.items.push_back(tree(node_of(pair->value), depth + 1));
      }
    }
    return result;
  }

  const std::string& path_;
  yaml_parser_t parser_{};
  yaml_document_t document_{};
  std::size_t nodes_ = 0;
};

TextNode tree_of(const cv::FileNode& node) {
  TextNode result;
  if (node.isMap() || node.isSeq()) {
    result.kind = node.isMap() ? TextNode::Kind::map : TextNode::Kind::list;
    if (node.isMap()) result.keys = node.keys();
    for (const cv::FileNode& item : node) result.items.push_back(tree_of(item));
  } else if (node.isString()) {
    result.text = node.string();
  } else if (!node.empty()) {
    result.text = number_text(node.real());
  }
  return result;
}

TextNode xml_tree(const std::string& path, const std::string& text) {
  try {
    const cv::FileStorage storage(text, cv::FileStorage::READ | cv::FileStorage::MEMORY | cv::FileStorage::FORMAT_XML);
    if (storage.isOpened()) return tree_of(storage.root());
  } catch (const cv::Exception& exception) {
    throw Error(path + ": is not XML that OpenCV can read (" + exception.err + ")");
  }
  throw Error(path + ": is not XML that OpenCV can read");
}

}  // namespace

const TextNode* TextNode::find(const std::string& key) const {
  const auto found = std::find(keys.begin(), keys.end(), key);
  return found == keys.end() ? nullptr : &items[static_cast<std::size_t>(found - keys.begin())];
}

TextNode read_text_tree(const std::string& path) {
  std::string text = text_of_file(path);
  refuse_binary(path, text);
  if (text.starts_with("<?xml")) return xml_tree(path, text);
  // OpenCV's first line, "%YAML:1.0", is no YAML; a comment keeps the lines' numbers.
  if (text.starts_with("%YAML")) text[0] = '#';
  return YamlReader(path, text).root();
}

}  // namespace catchlight::tracking
