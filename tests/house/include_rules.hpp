// What may include what, read from the files themselves.
#pragma once

#include <filesystem>
#include <functional>
#include <map>
#include <string>
#include <vector>

namespace catchlight::house {

struct SourceFile {
  int lines = 0;
  std::vector<std::string> includes;  ///< as they are written
};

/// Files of C++ by their path from the root, with forward slashes.
using SourceTree = std::map<std::string, SourceFile>;

SourceTree read_tree(const std::filesystem::path& root);

/// One line for each include that a rule of the house forbids, with the reason.
std::vector<std::string> forbidden_includes(const SourceTree& tree);

/// `foo.hpp` and `foo.cpp` are one unit.
std::string unit_of(const std::string& file);
/// Files that lie directly in a library's folder stand alone: its door and its plain data.
std::string folder_of(const std::string& file);
std::string library_of(const std::string& file);

/// Circles between what `node_of` makes of files (itself, its unit, its folder, its library): one line for each, naming all that
/// reach each other.
std::vector<std::string> include_circles(const SourceTree& tree, const std::function<std::string(const std::string&)>& node_of);

/// Folders with more than 25 files of one kind, and files of more than 400 lines.
std::vector<std::string> oversized(const SourceTree& tree);

}  // namespace catchlight::house
