#include "render/mesh_file/unused_features.hpp"

#include <algorithm>

namespace catchlight::render {
namespace {

constexpr std::size_t kMaxNamed = 3;

std::string names(const std::vector<std::string>& materials) {
  std::string text = " (material ";
  for (std::size_t i = 0; i < std::min(materials.size(), kMaxNamed); ++i) text += (i ? ", \"" : "\"") + materials[i] + '"';
  if (materials.size() > kMaxNamed) text += " and " + std::to_string(materials.size() - kMaxNamed) + " more";
  return text + ')';
}

}  // namespace

void UnusedFeatures::add(const std::string& what, const std::string& material) {
  auto found = std::find_if(features_.begin(), features_.end(), [&](const Feature& feature) { return feature.what == what; });
  if (found == features_.end()) found = features_.insert(features_.end(), {what, {}});
  std::vector<std::string>& named = found->materials;
  if (!material.empty() && std::find(named.begin(), named.end(), material) == named.end()) named.push_back(material);
}

void UnusedFeatures::report(const std::string& path, const WarningHandler& warn) const {
  if (!warn) return;
  for (const Feature& feature : features_)
    warn(path + ": " + feature.what + (feature.materials.empty() ? "" : names(feature.materials)));
}

}  // namespace catchlight::render
