// What the compositor refuses: data that do not fit together or are not numbers.
#pragma once

#include "render/frame_view.hpp"
#include "render/render_scene.hpp"

namespace catchlight::render {

/// The scene itself, checked: throws Error saying which parts disagree.
const RenderScene& checked(const RenderScene& scene);

/// Throws Error naming what is not finite or out of range.
void check_view(const FrameView& view);

/// Throws Error for a level that is not six square RGB faces, one below the other.
void check_cubes(const ReflectionMap& map);

}  // namespace catchlight::render
