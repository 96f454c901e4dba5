// What a model's file says and nobody draws.
#pragma once

#include <string>
#include <vector>

#include "catchlight/error.hpp"

namespace catchlight::render {

/// Collects what is not used of a file, so that each feature is said once, however many materials have it.
class UnusedFeatures {
 public:
  /// `what` is a sentence, such as "normal maps are not used". `material` is the name of one that has it, or empty.
  void add(const std::string& what, const std::string& material = "");

  /// Warns once for each sentence, in their order of appearance.
  void report(const std::string& path, const WarningHandler& warn) const;

 private:
  struct Feature {
    std::string what;
    std::vector<std::string> materials;
  };
  std::vector<Feature> features_;
};

}  // namespace catchlight::render
