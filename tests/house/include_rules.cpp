#include "tests/house/include_rules.hpp"

#include <algorithm>
#include <array>
#include <fstream>
#include <regex>
#include <set>
#include <string_view>

namespace catchlight::house {
namespace {

constexpr int kMaxFilesOfAKind = 25, kMaxLines = 400;
constexpr std::array kRoots = {"app", "bench", "catchlight", "render", "shaders", "tests", "tracking"};

/// Files under `from`, but not under `except`, include nothing that begins with one of `what`.
struct Rule {
  std::vector<std::string> from, except, what;
  std::string reason;
};

const std::vector<std::string> kNeedsGl = {"render/gl/", "render/passes/", "render/gl_compositor."};
const std::vector<std::string> kGl = {"epoxy/", "EGL/", "GL/"}, kFfmpeg = {"libav", "libsw"},
                               kFrontEnds = {"CLI/", "imgui", "GLFW/"};
const std::vector<std::string> kLibraries = {"catchlight/", "tracking/", "render/"};

const std::vector<Rule> kRules = {
    {{"tracking/"}, {}, {"render/"}, "tracking and render do not know each other"},
    {{"render/"}, {}, {"tracking/"}, "tracking and render do not know each other"},
    {kLibraries, {}, {"app/"}, "libraries do not know the program"},
    {kLibraries, {}, {"tests/", "bench/"}, "the product does not know its tests"},
    {{"app/"}, {}, {"tests/", "bench/"}, "the product does not know its tests"},
    {kLibraries, kNeedsGl, kGl, "only render/gl, render/passes and the GL compositor see GL"},
    {{"render/"}, kNeedsGl, kNeedsGl, "what needs no GL includes nothing that does"},
    {{"app/media/"}, {}, kNeedsGl, "footage needs no GL"},
    {{"app/media/"}, {}, {"tracking/"}, "footage knows no tags"},
    {kLibraries, {}, kFrontEnds, "only app sees the command line and windows"},
    {kLibraries, {}, kFfmpeg, "only app/media sees FFmpeg"},
    {{"app/"}, {"app/window/"}, {"imgui", "backends/imgui", "GLFW/"}, "only app/window sees windows"},
    // The command `info` prints FFmpeg's versions.
    {{"app/"}, {"app/media/", "app/commands/info.cpp"}, kFfmpeg, "only app/media sees FFmpeg"},
};

bool begins_with_any(const std::string& text, const std::vector<std::string>& beginnings) {
  return std::any_of(beginnings.begin(), beginnings.end(), [&](const std::string& b) { return text.starts_with(b); });
}

/// The vocabulary may have itself, GLM and the standard library, whose headers have neither folder nor ending; its sources may
/// ask the system for what the standard library has not.
bool is_vocabulary(const std::string& path, const std::string& include) {
  if (path.ends_with(".cpp") && (include == "fcntl.h" || include == "unistd.h")) return true;
  return include.starts_with("catchlight/") || include.starts_with("glm/") || include.find_first_of("/.") == std::string::npos;
}

SourceFile read_source(const std::filesystem::path& path) {
  static const std::regex kInclude("^\\s*#\\s*include\\s*[<\"]([^>\"]+)[>\"].*");
  SourceFile file;
  std::ifstream text(path);
  std::smatch match;
  for (std::string line; std::getline(text, line); ++file.lines)
    if (line.find("include") != std::string::npos && std::regex_match(line, match, kInclude)) file.includes.push_back(match[1]);
  return file;
}

std::string parent_of(const std::string& file) {
  return file.substr(0, file.rfind('/'));
}

using Graph = std::map<std::string, std::set<std::string>>;

Graph graph_of(const SourceTree& tree, const std::function<std::string(const std::string&)>& node_of) {
  Graph graph;
  for (const auto& [path, file] : tree)
    for (const std::string& include : file.includes)
      if (tree.contains(include) && node_of(path) != node_of(include)) graph[node_of(path)].insert(node_of(include));
  return graph;
}

void visit(const Graph& graph, const std::string& node, std::set<std::string>& reached) {
  const auto found = graph.find(node);
  if (found == graph.end()) return;
  for (const std::string& next : found->second)
    if (reached.insert(next).second) visit(graph, next, reached);
}

}  // namespace

SourceTree read_tree(const std::filesystem::path& root) {
  SourceTree tree;
  for (const char* folder : kRoots) {
    if (!std::filesystem::exists(root / folder)) continue;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(root / folder)) {
      const std::string extension = entry.path().extension().string();
      if (extension == ".hpp" || extension == ".cpp" || extension == ".h")
        tree[entry.path().lexically_relative(root).generic_string()] = read_source(entry.path());
    }
  }
  return tree;
}

std::vector<std::string> forbidden_includes(const SourceTree& tree) {
  std::vector<std::string> found;
  for (const auto& [path, file] : tree)
    for (const std::string& include : file.includes) {
      for (const Rule& rule : kRules)
        if (begins_with_any(path, rule.from) && !begins_with_any(path, rule.except) && begins_with_any(include, rule.what))
          found.push_back(path + " includes " + include + ": " + rule.reason);
      if (path.starts_with("catchlight/") && !is_vocabulary(path, include))
        found.push_back(path + " includes " + include + ": the vocabulary knows GLM and the standard library only");
    }
  return found;
}

std::string unit_of(const std::string& file) {
  return file.substr(0, file.rfind('.'));
}

std::string folder_of(const std::string& file) {
  const std::string folder = parent_of(file);
  return folder.find('/') == std::string::npos ? unit_of(file) : folder;
}

std::string library_of(const std::string& file) {
  if (file.starts_with("app/media/")) return "catchlight_media";
  if (file.starts_with("app/support/")) return "app/support";  // media and the rest of app use it
  if (begins_with_any(file, kNeedsGl)) return "catchlight_render";
  if (file.starts_with("render/reference/")) return "catchlight_reference";
  if (file.starts_with("render/")) return "catchlight_light";
  return file.substr(0, file.find('/'));
}

std::vector<std::string> include_circles(const SourceTree& tree, const std::function<std::string(const std::string&)>& node_of) {
  const Graph graph = graph_of(tree, node_of);
  std::map<std::string, std::set<std::string>> reached;
  for (const auto& [node, targets] : graph) visit(graph, node, reached[node]);
  std::vector<std::string> circles;
  std::set<std::string> told;
  for (const auto& [node, targets] : reached) {
    if (!targets.contains(node) || told.contains(node)) continue;
    std::string circle;
    for (const std::string& other : targets) {
      const auto back = reached.find(other);
      if (back == reached.end() || !back->second.contains(node)) continue;
      told.insert(other);
      circle += (circle.empty() ? "" : " <-> ") + other;
    }
    circles.push_back(circle);
  }
  return circles;
}

std::vector<std::string> oversized(const SourceTree& tree) {
  std::vector<std::string> found;
  std::map<std::string, int> counts;
  for (const auto& [path, file] : tree) {
    ++counts[parent_of(path) + "/*" + path.substr(path.rfind('.'))];
    if (file.lines > kMaxLines) found.push_back(path + " has " + std::to_string(file.lines) + " lines, more than 400");
  }
  for (const auto& [kind, count] : counts)
    if (count > kMaxFilesOfAKind) found.push_back(kind + " are " + std::to_string(count) + " files, more than 25");
  return found;
}

}  // namespace catchlight::house
