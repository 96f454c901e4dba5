// What a person looks at, and what of it has to be drawn beside the composite.
#pragma once

#include <array>
#include <optional>
#include <string>

namespace catchlight::app {

enum class View {
  composite,
  plate,
  truth,
  split,
  flicker,
  difference,
  zones,
  object,  ///< this and all that follow are layers, drawn only where they are looked at
  reflection,
  shadow,
  glare,
  normals,
  depth,
  light  ///< what one light adds, or the environment
};
constexpr auto names_of(View) {
  return std::array{"composite", "plate",      "truth",  "split", "flicker", "difference", "zones",
                    "object",    "reflection", "shadow", "glare", "normals", "depth",      "light"};
}

inline bool is_layer(View view) {
  return view >= View::object;
}

/// "environment", "light 1", ...
inline std::string light_name(int light) {
  return light == 0 ? "environment" : "light " + std::to_string(light);
}

/// What is drawn of a frame beside its composite, which stays the same.
struct FrameExtras {
  std::optional<View> layer;  ///< one of the layers
  int light = 0;              ///< of View::light: 0 is the environment, then the lights, brightest first
  bool masks = false;         ///< what the object covers, and where it shadows
  bool corners = false;       ///< the tag's corners as this frame alone shows them
  bool operator==(const FrameExtras&) const = default;
};

}  // namespace catchlight::app
