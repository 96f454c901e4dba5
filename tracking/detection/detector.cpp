#include "tracking/detection/detector.hpp"

#include <apriltag/apriltag.h>

#include <algorithm>
#include <tuple>

#include "catchlight/error.hpp"
#include "tracking/detection/families.hpp"

namespace catchlight::tracking {
namespace {

using DetectorPtr = std::unique_ptr<apriltag_detector, decltype(&apriltag_detector_destroy)>;
using DetectionsPtr = std::unique_ptr<zarray_t, decltype(&apriltag_detections_destroy)>;

/// The library thresholds in tiles of 4x4 pixels and divides by their number.
constexpr int kMinImagePx = 16;

void check_options(const TrackerOptions& options) {
  if (options.max_hamming < 0 || options.max_hamming > 2)
    throw Error("corrected bits (max_hamming) must be 0, 1 or 2, not " + std::to_string(options.max_hamming));
}

}  // namespace

std::array<glm::dvec2, 4> corners_from_library(const double (&library_corners)[4][2]) {
  std::array<glm::dvec2, 4> corners_px;
  for (int i = 0; i < 4; ++i) corners_px[i] = {library_corners[i][0] - 0.5, library_corners[i][1] - 0.5};
  return corners_px;
}

struct Detector::Impl {
  std::vector<FamilyPtr> families;
  DetectorPtr detector{apriltag_detector_create(), apriltag_detector_destroy};
};

Detector::Detector(const std::string& family, const TrackerOptions& options) : Detector(std::vector{family}, options) {}

Detector::Detector(const std::vector<std::string>& families, const TrackerOptions& options) {
  check_options(options);
  impl_ = std::make_unique<Impl>();
  for (const std::string& name : families) {
    const FamilyPtr& family = impl_->families.emplace_back(create_family(name));
    apriltag_detector_add_family_bits(impl_->detector.get(), family.get(), options.max_hamming);
  }
  // With more, version 3.3.0 crashes now and then: a worker thread that starts late reads its task from a list that still grows,
  // and calls what it finds in freed memory (AprilRobotics/apriltag#339).
  impl_->detector->nthreads = 1;
}

Detector::~Detector() = default;
Detector::Detector(Detector&&) noexcept = default;
Detector& Detector::operator=(Detector&&) noexcept = default;

std::vector<Detection> Detector::detect(const LumaView& luma, double decimate) {
  if (!(decimate >= 1 && decimate <= 8))
    throw Error("the detector's decimation must be from 1 to 8, not " + std::to_string(decimate));
  impl_->detector->quad_decimate = static_cast<float>(decimate);
  std::vector<Detection> found;
  if (std::min(luma.width_px, luma.height_px) < kMinImagePx) return found;
  // The library only reads the image, but its struct is not const-correct.
  image_u8_t image{luma.width_px, luma.height_px, luma.stride, const_cast<std::uint8_t*>(luma.data)};
  const DetectionsPtr detections(apriltag_detector_detect(impl_->detector.get(), &image), apriltag_detections_destroy);
  for (int i = 0; i < zarray_size(detections.get()); ++i) {
    apriltag_detection_t* detection = nullptr;
    zarray_get(detections.get(), i, &detection);
    const auto is_its = [&](const FamilyPtr& family) { return family.get() == detection->family; };
    const auto family = std::find_if(impl_->families.begin(), impl_->families.end(), is_its) - impl_->families.begin();
    found.push_back({detection->id, detection->hamming, detection->decision_margin, corners_from_library(detection->p),
                     static_cast<std::size_t>(family)});
  }
  const auto key = [](const Detection& d) { return std::tuple(d.family, d.id, d.corners_px[0].x, d.corners_px[0].y); };
  std::sort(found.begin(), found.end(), [&](const Detection& a, const Detection& b) { return key(a) < key(b); });
  return found;
}

}  // namespace catchlight::tracking
