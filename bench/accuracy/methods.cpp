#include "bench/accuracy/methods.hpp"

#include <algorithm>
#include <future>
#include <opencv2/calib3d.hpp>
#include <thread>
#ifdef CATCHLIGHT_WITH_ARUCO
#include <opencv2/aruco.hpp>
#endif

#include "catchlight/camera.hpp"
#include "catchlight/track.hpp"
#include "tracking/detection/detector.hpp"
#include "tracking/observation.hpp"
#include "tracking/shot_tracker.hpp"
#include "tracking/tracker.hpp"

namespace catchlight::tracking {
namespace {

/// OpenCV's own IPPE, the better of its two poses.
std::optional<Estimate> with_pose(const Clip& clip, const Corners& corners_px) {
  const CameraModel& camera = clip.camera;
  const cv::Matx33d intrinsics(camera.fx_px, 0, camera.cx_px, 0, camera.fy_px, camera.cy_px, 0, 0, 1);
  const double h = clip.target.size_m / 2;
  // IPPE_SQUARE wants the square's corners in this order.
  const std::vector<cv::Point3d> square{{-h, h, 0}, {h, h, 0}, {h, -h, 0}, {-h, -h, 0}};
  std::vector<cv::Point2d> seen;
  for (const int i : {3, 2, 1, 0}) seen.emplace_back(corners_px[i].x, corners_px[i].y);
  std::vector<cv::Mat> rotations, translations;
  const std::vector<double> distortion(camera.distortion.begin(), camera.distortion.end());
  const int count =
      cv::solvePnPGeneric(square, seen, intrinsics, distortion, rotations, translations, false, cv::SOLVEPNP_IPPE_SQUARE);
  if (count < 1) return std::nullopt;
  cv::Matx33d rotation;
  cv::Rodrigues(rotations[0], rotation);
  Estimate estimate{corners_px, {}};
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column) estimate.camera_from_tag.rotation[column][row] = rotation(row, column);
    estimate.camera_from_tag.translation_m[row] = translations[0].at<double>(row);
  }
  return estimate;
}

template <typename EstimateFrame>
MethodResult frame_by_frame(const std::string& method, const Clip& clip, const EstimateFrame& estimate) {
  MethodResult result{method, {}};
  for (const ClipFrame& frame : clip.frames) result.estimates.push_back(frame.judged ? estimate(frame) : std::nullopt);
  return result;
}

MethodResult apriltag_alone(const Clip& clip) {
  Detector detector(clip.target.family, {.refinement = Refinement::none});
  return frame_by_frame("AprilTag", clip, [&](const ClipFrame& frame) -> std::optional<Estimate> {
    for (const Detection& detection : detector.detect(frame.picture.luma(), 1))
      if (detection.id == clip.target.id) return with_pose(clip, detection.corners_px);
    return std::nullopt;
  });
}

#ifdef CATCHLIGHT_WITH_ARUCO
/// `origin_px` is where the module has the centre of the first pixel: with its AprilTag detector half a pixel off OpenCV's own.
MethodResult aruco(const std::string& method, const Clip& clip, cv::aruco::CornerRefineMethod refinement, double origin_px) {
  const auto dictionary = cv::aruco::getPredefinedDictionary(cv::aruco::DICT_APRILTAG_36h11);
  const auto parameters = cv::aruco::DetectorParameters::create();
  parameters->cornerRefinementMethod = refinement;
  return frame_by_frame(method, clip, [&](const ClipFrame& frame) -> std::optional<Estimate> {
    const cv::Mat codes(frame.picture.height_px, frame.picture.width_px, CV_8U,
                        const_cast<std::uint8_t*>(frame.picture.codes.data()));
    std::vector<std::vector<cv::Point2f>> squares;
    std::vector<int> ids;
    cv::aruco::detectMarkers(codes, dictionary, squares, ids, parameters);
    for (std::size_t i = 0; i < ids.size(); ++i) {
      if (ids[i] != clip.target.id) continue;
      Corners corners_px;
      // It starts at the top left of the print as OpenCV draws it, clockwise; AprilTag's own drawing is turned by half.
      for (int k = 0; k < 4; ++k) corners_px[k] = glm::dvec2(squares[i][(5 - k) % 4].x, squares[i][(5 - k) % 4].y) - origin_px;
      return with_pose(clip, corners_px);
    }
    return std::nullopt;
  });
}
#endif

std::optional<Estimate> estimate_of(const TagObservation& seen) {
  if (seen.state != TrackState::tracking) return std::nullopt;
  return Estimate{seen.corners_px, seen.camera_from_tag};
}

MethodResult rung(const std::string& method, const Clip& clip, Refinement refinement) {
  return frame_by_frame(method, clip, [&](const ClipFrame& frame) {
    Tracker tracker(clip.camera, clip.target, {.refinement = refinement});
    return estimate_of(tracker.track(frame.picture.luma(), frame.time_s));
  });
}

}  // namespace

std::vector<MethodResult> peers(const Clip& clip) {
  std::vector<MethodResult> results{apriltag_alone(clip)};
#ifdef CATCHLIGHT_WITH_ARUCO
  results.push_back(aruco("aruco, apriltag", clip, cv::aruco::CORNER_REFINE_APRILTAG, 0.5));
  results.push_back(aruco("aruco, subpix", clip, cv::aruco::CORNER_REFINE_SUBPIX, 0));
#endif
  return results;
}

std::vector<MethodResult> rungs(const Clip& clip) {
  return {rung("none", clip, Refinement::none), rung("corners", clip, Refinement::corners),
          rung("direct", clip, Refinement::direct)};
}

std::vector<MethodResult> followed(const Clip& clip) {
  ShotTracker tracker(clip.camera, clip.target, {});
  MethodResult causal{"direct, follow", {}}, solved{"direct, solved", {}};
  for (const ClipFrame& frame : clip.frames)
    causal.estimates.push_back(estimate_of(tracker.add(frame.picture.luma(), frame.time_s)));
  for (const SolvedPose& pose : tracker.solve()) {
    if (pose.state != TrackState::tracking) {
      solved.estimates.push_back(std::nullopt);
      continue;
    }
    SyntheticTag tag{clip.target, pose.camera_from_tag};
    solved.estimates.push_back(Estimate{true_corners_px(clip.camera, tag), pose.camera_from_tag});
  }
  return {causal, solved};
}

void each_clip(unsigned count, const std::function<Clip(unsigned seed)>& make, const std::vector<Measure>& measures,
               const std::function<void(const Clip&, const MethodResult&)>& take) {
  using Measured = std::pair<Clip, std::vector<MethodResult>>;
  const auto measured = [&](unsigned seed) {
    Measured result{make(seed), {}};
    for (const Measure& measure : measures)
      for (MethodResult& each : measure(result.first)) result.second.push_back(std::move(each));
    return result;
  };
  const unsigned at_once = std::max(1u, std::thread::hardware_concurrency());
  for (unsigned first = 1; first <= count; first += at_once) {
    std::vector<std::future<Measured>> tasks;
    for (unsigned seed = first; seed <= count && seed < first + at_once; ++seed)
      tasks.push_back(std::async(std::launch::async, measured, seed));
    for (auto& task : tasks) {
      const auto [clip, results] = task.get();
      for (const MethodResult& result : results) take(clip, result);
    }
  }
}

}  // namespace catchlight::tracking
