// What each light of a scene adds to a picture. Light is linear: the parts make up the whole.
#pragma once

#include <glm/glm.hpp>
#include <span>

#include "catchlight/composite.hpp"
#include "catchlight/image.hpp"
#include "render/frame_view.hpp"
#include "render/render_scene.hpp"
#include "render/settings.hpp"

namespace catchlight::render {

/// The scene with nothing that shines but these of its lights: no sky, nothing to mirror but their highlights, no emission.
RenderScene lit_alone(const RenderScene& scene, std::span<const LightSample> lights);

/// The settings and the view to draw such a scene with: no glare and no tone curve, for they are not linear; no black level, for
/// it is no light.
CompositorSettings settings_alone(CompositorSettings settings);
FrameView view_alone(FrameView view);

/// The share of the receiver's open light that comes from these lights, a channel each; 0 where there is no receiver.
glm::dvec3 plane_share(const RenderScene& scene, std::span<const LightSample> lights, const glm::dmat3& tag_from_light);

/// What the layers make together without glare, RGB, where the plate holds that share of its light.
Image light_of(const Layers& layers, const glm::dvec3& plane_share);

}  // namespace catchlight::render
