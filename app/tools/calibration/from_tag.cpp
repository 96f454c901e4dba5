#include "app/tools/calibration/from_tag.hpp"

#include <algorithm>

#include "app/tools/calibration/collect.hpp"
#include "catchlight/error.hpp"
#include "catchlight/tag.hpp"
#include "catchlight/util/text.hpp"
#include "tracking/camera/camera_file.hpp"
#include "tracking/detection/detector.hpp"

namespace catchlight::app {
namespace {

constexpr double kGuessedFovDeg = 60;

/// A tag as the smallest of boards, which shows its views to a FocalMeter.
class TagViews : public CalibrationBoard {
 public:
  TagViews(const CameraModel& guess, const std::string& family, int id)
      : id_(id), detector_(family, {}), meter_(guess, PrintedTag{family, id}) {}

  std::optional<BoardView> find(const LumaView& luma, const CameraModel&) override {
    const std::vector<tracking::Detection> all = detector_.detect(luma);
    const auto is_wanted = [&](const tracking::Detection& detection) { return detection.id == id_; };
    if (std::ranges::count_if(all, is_wanted) != 1) return {};  // of two that are alike, either may be meant
    const tracking::Quad& corners_px = std::ranges::find_if(all, is_wanted)->corners_px;
    meter_.add(luma, corners_px);
    BoardView view;
    view.points_px.assign(corners_px.begin(), corners_px.end());
    for (const glm::dvec3& corner : tag_corners_m(1)) view.points_board_m.emplace_back(corner);
    return view;
  }
  bool needs_camera() const override { return false; }

  std::optional<tracking::FocalEstimate> focal_length() const { return meter_.estimate(); }

 private:
  int id_;
  tracking::Detector detector_;
  tracking::FocalMeter meter_;
};

}  // namespace

CameraFromTag camera_from_tag(MediaSource& source, const std::string& name, const std::string& family, int id,
                              const FrameRange& range, Log& log) {
  const CameraModel guess = tracking::camera_from_field_of_view(source.info().width_px, source.info().height_px, kGuessedFovDeg);
  TagViews tag(guess, family, id);
  const CollectedViews views = collect_views(source, tag, range, log);
  if (views.damage) log.warn(*views.damage + "; using what was read before");
  const std::string which = "tag " + std::to_string(id) + " of " + family;
  if (views.frames_with_board == 0)
    throw Error(name + ": " + which + " was found in none of " + std::to_string(views.frames_tried) +
                " frames; expected it once in the picture, sharp and evenly lit");
  log.info(which + " seen in " + std::to_string(views.frames_with_board) + " of " + std::to_string(views.frames_tried) +
           " frames tried, of " + std::to_string(views.frames_read));
  const auto focal = tag.focal_length();
  if (!focal)
    throw Error(name + ": " + which +
                " does not tell the focal length: it is small, stays frontal or hardly moves; film it large and tilted by 30 "
                "degrees and more, to several sides, or calibrate with a board (docs/calibration.md)");
  CameraFromTag result{guess, *focal};
  result.camera.fx_px = result.camera.fy_px = focal->fx_px;
  return result;
}

std::string camera_from_tag_text(const CameraFromTag& result) {
  const double fov_deg = tracking::horizontal_fov_deg(result.camera);
  return "focal length     " + fixed_text(result.focal_length.fx_px, 1) + " +- " +
         fixed_text(result.focal_length.deviation_px, 1) + " px, a horizontal field of view of " + fixed_text(fov_deg, 1) +
         " degrees, from " + std::to_string(result.focal_length.looks) + " views of the tag\n" +
         "principal point  taken to be the middle\ndistortion       taken to be none: a board tells both\n";
}

}  // namespace catchlight::app
