// What a scene file says: the tag, the objects on it, the light, the lens. Every member is a row of the table in
// parameter_table.cpp.
#pragma once

#include <array>
#include <glm/glm.hpp>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "catchlight/camera.hpp"
#include "catchlight/tag.hpp"
#include "catchlight/util/enum_names.hpp"
#include "render/probe/probe.hpp"
#include "render/settings.hpp"
#include "tracking/tracker_options.hpp"

namespace catchlight::app {

/// Left to the program, or forced.
enum class Switch { automatic, off, on };
constexpr auto names_of(Switch) {
  return std::array{"auto", "false", "true"};
}

/// How an object is lit.
enum class Shading {
  prt  ///< precomputed radiance transfer, with mirror reflections
};
constexpr auto names_of(Shading) {
  return std::array{"prt"};
}

/// The real surface that catches the shadow.
enum class ReceiverPlane { tag, none };
constexpr auto names_of(ReceiverPlane) {
  return std::array{"tag", "none"};
}

/// What the light stands still with.
enum class LightFrame { tag, camera };
constexpr auto names_of(LightFrame) {
  return std::array{"tag", "camera"};
}

/// The source of the virtual layer's exposure (docs/exposure.md).
enum class ExposureMode {
  match,     ///< the footage's, read off the tag
  fixed,     ///< radiance as it is
  automatic  ///< the footage's, and then the whole picture is exposed anew
};
constexpr auto names_of(ExposureMode) {
  return std::array{"match", "fixed", "auto"};
}

/// What draws: `automatic` is the card's OpenGL where there is a card, else the processor.
enum class Renderer { automatic, cpu, gl };
constexpr auto names_of(Renderer) {
  return std::array{"auto", "cpu", "gl"};
}

struct SceneSettings {
  render::Look look = render::Look::camera;

  struct Tag {
    std::string family = "tag36h11";
    int id = 0;
    double size_m = 0.08;
    double white_albedo = 0.8, black_albedo = 0.04;
    tracking::Refinement refinement = tracking::Refinement::direct;

    /// A further tag of a board.
    struct Bundled {
      std::string family = "same";  ///< "same": as the tag itself
      int id = 0;
      double size_m = 0;  ///< 0: as the tag itself
      glm::dvec3 translation_m{0.0}, rotation_deg{0.0};
    };
    std::vector<Bundled> bundle;

    TagTarget target() const;
    tracking::TrackerOptions tracker_options() const;
  } tag;

  struct Object {
    std::string mesh;
    glm::dvec3 translation_m{0.0};
    glm::dvec3 rotation_deg{0.0};
    double scale = 1.0;
    std::optional<glm::dmat4> matrix;  ///< stands for the three above where the file gives it
    Shading shading = Shading::prt;

    /// matrix, or translation * Rz * Ry * Rx * scale: turned about the tag's x axis first, then y, then z.
    glm::dmat4 tag_from_object() const;
  };
  std::vector<Object> objects;

  struct Receiver {
    ReceiverPlane plane = ReceiverPlane::tag;
    glm::dvec3 albedo{0.8};
  } receiver;

  struct Probe {
    std::string image = "studio";
    std::optional<render::ProbeLayout> layout;  ///< empty: as the file says, else by its shape
    render::UpAxis up = render::UpAxis::z;
    double yaw_deg = 0;
    LightFrame fixed_to = LightFrame::tag;
    double ev = 0;
    bool strict = false;  ///< refuse bad texels; the command line's --strict, not a key of the file
  } probe;

  struct Exposure {
    ExposureMode mode = ExposureMode::match;
    double ev = 0;
    glm::dvec3 white_balance{1.0};
    std::string response = "footage";                 ///< as app/response/response_file.hpp says
    double key = 0.18;                                ///< what "auto" exposes the log-average to
    double adapt_bright_s = 0.4, adapt_dark_s = 1.6;  ///< time constants of "auto"
  } exposure;

  render::GlareSettings glare;

  struct Lens {
    Switch noise = Switch::automatic, motion_blur = Switch::automatic, defocus = Switch::automatic,
           distortion = Switch::automatic, vignetting = Switch::automatic, chroma_subsampling = Switch::automatic;
    double shutter = 0;  ///< 0: measured

    /// The camera without what is switched off here: its distortion, its vignetting.
    CameraModel as_drawn(CameraModel camera) const;
  } lens;

  struct Quality {
    double tolerance = 0.004;
    int bands = 7;
    int rays = 1024;
    int bounces = 8;
    int light_samples = 96;
    int samples = 4;
    int reflection_rays = 32;
    int receiver_points = 96;
  } quality;

  Renderer renderer = Renderer::automatic;  ///< the command line's --renderer, not a key of the file
  std::string folder;                       ///< paths of files above that are relative start here; empty: the working folder
  std::string shader_folder;      ///< instead of the embedded shaders; the command line's --shader-dir, not a key of the file
  std::set<std::string> by_hand;  ///< keys that the scene file or the command line gave

  bool is_by_hand(const std::string& key) const { return by_hand.contains(key); }
  /// A path as the file system needs it.
  std::string resolve(const std::string& path) const;
};

}  // namespace catchlight::app
