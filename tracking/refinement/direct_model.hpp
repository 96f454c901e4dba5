// The model that direct refinement fits, its derivatives, and one step of the fit.
#pragma once

#include <array>
#include <opencv2/core.hpp>
#include <optional>
#include <vector>

#include "catchlight/camera.hpp"
#include "catchlight/rigid_transform.hpp"
#include "catchlight/track.hpp"
#include "tracking/refinement/response_table.hpp"
#include "tracking/refinement/tag_pattern.hpp"
#include "tracking/refinement/tag_pixels.hpp"

namespace catchlight::tracking {

/// Light on one tag: linear luma of its black, and what white adds to it, changing linearly from side to side.
struct TagLight {
  double black = 0, gain = 0;
  double gain_u = 0, gain_v = 0;  ///< what the gain gains from the middle to the right, and to the bottom side
};

/// A tag of the board with the pixels that see it.
struct TagPart {
  const TagPattern* pattern;
  double size_m;
  RigidTransform target_from_tag;
  std::vector<TagPixel> pixels;
};

struct DirectParameters {
  RigidTransform camera_from_target;
  Covariance2 blur_px2;
  std::vector<TagLight> light;  ///< one for each part
};

/// Geman and McClure's: residuals far beyond `scale` stop counting.
struct RobustLoss {
  double scale = 1;
  double loss(double residual) const;
  double weight(double residual) const;
};

inline constexpr int kSharedParameters = 9;  ///< rotation, translation, blur xx, xy, yy
inline constexpr int kLightParameters = 4;

struct NormalEquations {
  using Shared = cv::Matx<double, kSharedParameters, kSharedParameters>;
  using Cross = cv::Matx<double, kSharedParameters, kLightParameters>;
  using Light = cv::Matx<double, kLightParameters, kLightParameters>;
  struct Part {
    Cross cross = Cross::zeros();
    Light light = Light::zeros();
    cv::Vec<double, kLightParameters> right = cv::Vec<double, kLightParameters>::all(0);
  };
  Shared shared = Shared::zeros();
  cv::Vec<double, kSharedParameters> right = cv::Vec<double, kSharedParameters>::all(0);
  std::vector<Part> parts;
  double cost = 0;
};

/// What the model leaves of a pixel.
struct Residual {
  bool known = false;  ///< false: its ray misses the plane, or unknown cells reach into it
  bool edge = false;
  double code = 0;  ///< normalised code seen less that modelled
};

/// The model about some parameters, of every pixel, part after part.
struct Linearized {
  static constexpr int kColumns = 16;  ///< parameters, the residual, and two that stay empty
  static_assert(kColumns % 4 == 0 && kColumns > kSharedParameters + kLightParameters);
  using Row = std::array<double, kColumns>;

  std::vector<Residual> residuals;
  std::vector<Row> rows;  ///< d code / d parameters, then the residual
};

class DirectModel {
 public:
  DirectModel(const CameraModel& camera, const ResponseTable& response, std::vector<TagPart> parts)
      : camera_(camera), response_(&response), parts_(std::move(parts)) {}

  const std::vector<TagPart>& parts() const { return parts_; }

  /// One residual for every `stride`-th pixel, part after part.
  std::vector<Residual> residuals(const DirectParameters& at, std::size_t stride = 1) const;

  Linearized linearize(const DirectParameters& at) const;

  /// The equations of the model linearized: those of another loss cost no second look at the pattern.
  NormalEquations equations(const Linearized& linearized, const RobustLoss& loss) const;

  /// Each part's light from its own lighter and darker pixels. False where a part shows no contrast.
  bool guess_light(DirectParameters& at) const;

 private:
  CameraModel camera_;
  const ResponseTable* response_;
  std::vector<TagPart> parts_;
};

/// The step that solves the equations, damped by Levenberg's and Marquardt's rule, `stretch` times as far; empty where they have
/// no solution.
std::optional<DirectParameters> stepped(const DirectParameters& from, const NormalEquations& equations, double damping,
                                        double stretch = 1);

/// Inverse of the equations for the pose alone, everything else unknown; empty where they are singular.
std::optional<cv::Matx66d> pose_covariance(const NormalEquations& equations);

}  // namespace catchlight::tracking
