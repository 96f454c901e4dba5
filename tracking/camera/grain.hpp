// Measures the footage's grain, the sensor's noise, where its picture is known to be flat: inside the cells of the tag's print,
// and on its sheet.
#pragma once

#include <span>

#include "catchlight/camera.hpp"
#include "catchlight/frame_image.hpp"
#include "catchlight/tag.hpp"
#include "catchlight/track.hpp"

namespace catchlight::tracking {

/// What one cell shows.
struct FlatPatch {
  glm::dvec3 light{0.0};       ///< mean, exposed linear
  glm::dmat3 covariance{0.0};  ///< the light's
  double luma_variance = 0;    ///< in codes, of what a plane leaves
  double fine_variance = 0;    ///< luma's, by its mixed second differences: the same for white noise, nothing for streaks
  double freedom = 0;          ///< degrees of freedom
  bool is_on_print = true;     ///< or on what may be the sheet around it
};

/// White cells give the noise of one brightness, black cells of another, and changing exposure of more; every frame adds to the
/// same sums. In each cell a plane is taken off luma (a pixel a value) and off colour (a chroma sample a value), so that neither
/// shading nor the codec's coarser chroma counts as more or less noise; degrees of freedom and the variance of rounding (1/12
/// code^2) are allowed for. Cells that are not flat (dust, a shadow's edge, the object in front) stand out from the others'
/// median and are left out. A print has a texture of its own (streaks of toner, paper). It is coarser than grain: what fine
/// differences see less than a third of counts only as three times that. Codecs keep less noise near the print's edges than on a
/// plain: cells of the sheet around it that are as bright as its white, and do not stand out either, count instead where there
/// are as many.
class GrainMeter {
 public:
  GrainMeter(const CameraModel& camera, const TagTarget& target) : camera_(camera), target_(target) {}

  /// Counts where the row's tag was seen and its blur measured.
  void add(const FrameImage& frame, const TrackRow& row);

  /// The model that fits best by weighted least squares; slopes are not negative, nor is the variance where light is 0.03 or
  /// more. Not measured where the cells were too small.
  NoiseModel model() const;

 private:
  void add_tag(const FrameImage& frame, const TrackRow& row, const BundledTag& tag);
  /// Adds the flats of one ink, or those of the `paper` that is like it.
  void add_alike(std::span<const FlatPatch> flats, std::span<const FlatPatch> paper);
  void add(const FlatPatch& flat);

  CameraModel camera_;
  TagTarget target_;
  // Sums of weight and, weighted, of light, light squared, variance, light times variance.
  glm::dvec3 w_{0.0}, wi_{0.0}, wii_{0.0}, wv_{0.0}, wiv_{0.0};
  glm::dmat3 together_{0.0};  ///< covariances, for the correlation
};

}  // namespace catchlight::tracking
