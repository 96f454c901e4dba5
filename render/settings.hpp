// How a scene is drawn: glare, tone, quality.
#pragma once

#include <array>
#include <string>

#include "render/tone/tone_curve.hpp"

namespace catchlight::render {

enum class GlareMethod {
  fast,  ///< bloom and streaks, drawn on a grid
  fft    ///< what an aperture diffracts, as render/glare/fft_glare.hpp says
};
constexpr auto names_of(GlareMethod) {
  return std::array{"fast", "fft"};
}

struct GlareSettings {
  bool enabled = true;
  double threshold = 1.0;  ///< exposed linear value above which the lens spills; 1 = sensor white
  double brightest = 3e4;  ///< what the light of a highlight tends to, however bright it is
  double bloom_strength = 0.05;
  double streak_strength = 0.04;
  int streak_directions = 4;
  double streak_attenuation = 0.92;  ///< a of a^k, per pixel at a frame height of 480 px
  double streak_dispersion = 0;      ///< 1: a streak is as long as its colour's wavelength says; 0: all alike
  double streak_rotation_deg = 45;
  double streak_width = 0.006;  ///< standard deviation across, in shares of the frame's height
  double emitter_strength = 1;  ///< glare of what the object's materials emit, against what else is as bright
  int emitter_directions = 0;   ///< streak directions of what the materials emit; 0: as of the rest
  int streak_passes = 0;        ///< passes of four samples each; 0: as many as can be seen
  int grid_rows = 240;          ///< resolution that glare is computed at; texels are never smaller than pixels
  GlareMethod method = GlareMethod::fast;
  std::string aperture = "none";  ///< "none", or what aperture_picture() takes
  double aperture_mm = 2;         ///< width of the aperture's picture
  double aperture_strength = 1;   ///< 1: as much as the aperture diffracts

  bool operator==(const GlareSettings&) const = default;
};

/// `classic`: bloom and streaks of the whole picture as in render/passes/glare/classic_glare.hpp, instead of those of the
/// object's highlights.
enum class Look { camera, classic };
constexpr auto names_of(Look) {
  return std::array{"camera", "classic"};
}

struct CompositorSettings {
  GlareSettings glare;
  Look look = Look::camera;
  ToneSettings tone;          ///< with it, or with the classic look, every pixel of every frame changes
  int samples = 4;            ///< multisampling of the object's edges
  int reflection_rays = 16;   ///< rays over the lobe of a rough surface; 0: the probe alone is mirrored
  std::string shader_folder;  ///< overrides the embedded shaders where not empty

  bool operator==(const CompositorSettings&) const = default;
};

}  // namespace catchlight::render
