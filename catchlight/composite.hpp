// What the renderer gives back for one frame.
#pragma once

#include <functional>
#include <memory>
#include <optional>

#include "catchlight/image.hpp"
#include "catchlight/pixel_rect.hpp"
#include "catchlight/plate.hpp"
#include "catchlight/tone_curve.hpp"
#include "catchlight/util/raw_vector.hpp"

namespace catchlight {

/// Layers for compositing packages, whole frame, premultiplied, exposed linear in the plate's primaries.
struct Layers {
  Image plate, object /* RGBA */, shadow, reflection, glare, normal,
      depth /* metres along z, 1 channel; infinite where no object is */;
};

/// What the layers make together, RGBA: plate * shadow * (1 - object.a) + object + glare, and a = 1, as it fills the frame.
Image recompose(const Layers& layers);

/// The changed part of a frame. RGBA floats: display codes as the footage's, alpha 1 where the virtual layer changed the pixel,
/// else 0.
struct Composite {
  PixelRect rect;                           ///< empty: nothing virtual in sight
  RawVector<float> rgba;                    ///< row-major within rect; empty where a CompositeSink took it
  std::shared_ptr<const Plate> plate = {};  ///< what it is drawn over, at least within rect; null where it was not kept
  bool glare_drawn = false;
  PixelRect glare_rect;  ///< what glare reaches, where it is drawn
  std::optional<Layers> layers;
  ToneCurve tone_wanted;  ///< what the frame calls for, where tone settings are enabled
};

/// Takes a composite as bands of its rows, each finished as it comes, from several threads. A band's rows are those from one
/// multiple of kCompositeBandRows to the next, and it is gone after the call. Pixels that did not change need have no codes.
using CompositeSink = std::function<void(const Composite& band)>;
inline constexpr int kCompositeBandRows = 8;

}  // namespace catchlight
