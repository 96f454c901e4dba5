#include "app/tools/probe_merge/merge.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "app/tools/probe_merge/orientation.hpp"
#include "app/tools/probe_merge/photographs.hpp"
#include "catchlight/camera.hpp"
#include "catchlight/error.hpp"
#include "catchlight/image.hpp"
#include "catchlight/response.hpp"
#include "catchlight/util/text.hpp"
#include "tracking/camera/camera_file.hpp"

namespace catchlight::app {
namespace {

void check_count(std::size_t given, std::size_t views, const char* option) {
  if (given > 0 && given != views)
    throw UsageError(std::string(option) + " is given for " + std::to_string(given) + " views, but there are " +
                     std::to_string(views) + "; give it once for each view");
}

void check(const MergeRequest& request) {
  if (request.views.empty()) throw UsageError("no photographs; give those of one camera position, or --view FILE... for each");
  for (const auto& view : request.views)
    if (view.empty()) throw UsageError("--view needs the files of a camera position");
  const std::size_t views = request.views.size();
  check_count(request.balls.size(), views, "--ball");
  check_count(request.view_yaw_deg.size(), views, "--view-yaw");
  check_count(request.view_pitch_deg.size(), views, "--view-pitch");
  const bool has_angles = !request.view_yaw_deg.empty() || !request.view_pitch_deg.empty();
  if (request.tag && has_angles)
    throw UsageError("--view-yaw and --view-pitch stand for a tag beside the ball; leave out --scene and --tag-size-m, or them");
  if (request.tag && !request.camera_file && !request.fov_deg)
    throw UsageError("the tag's direction needs the camera that took the photographs: give --camera FILE or --fov DEGREES");
  if (!request.tag && views > 1 && request.view_yaw_deg.empty())
    throw UsageError(
        "several views need to know how they stand to each other: a tag beside the ball (--tag-size-m or --scene), or "
        "--view-yaw for each");
  if (request.camera_file) tracking::read_camera_file(*request.camera_file);
  for (const auto& view : request.views) check_photographs(view);
}

/// One view's own part of all exposure times.
std::vector<double> times_of(const MergeRequest& request, std::size_t view) {
  if (request.times_s.empty()) return {};
  std::size_t before = 0, all = 0;
  for (std::size_t i = 0; i < request.views.size(); ++i) {
    if (i < view) before += request.views[i].size();
    all += request.views[i].size();
  }
  const std::size_t count = request.views[view].size();
  if (request.times_s.size() == count && request.views.front().size() == count) return request.times_s;
  if (request.times_s.size() != all)
    throw UsageError("--times has " + counted(request.times_s.size(), "time") + " for " + counted(all, "photograph") +
                     "; give one for each, in the order of the files");
  const auto first = request.times_s.begin() + static_cast<std::ptrdiff_t>(before);
  return {first, first + static_cast<std::ptrdiff_t>(count)};
}

std::string view_name(const MergeRequest& request, std::size_t view) {
  return request.views[view].front() + (request.views[view].size() > 1 ? " ..." : "");
}

/// Finds the camera's response. That of the first bracket that tells it stands for all: they are one camera's.
class ResponseFinder {
 public:
  ResponseFinder(std::string wanted, Log& log) : wanted_(std::move(wanted)), log_(log) {}

  const LightOfCodes& of(const Bracket& bracket) {
    const int max_code = bracket.front().max_code();
    constexpr std::size_t kMinPhotographs = 3;
    const bool is_recoverable = bracket.size() >= kMinPhotographs && max_code == 255;
    if (wanted_ == "recover" && !is_recoverable && recovered_.front().empty())
      throw UsageError("--response recover needs at least three photographs with 8 bits; give more, or --response srgb");
    const bool recovers = wanted_ == "recover" || (wanted_ == "auto" && is_recoverable);
    if (recovers || (wanted_ == "auto" && max_code == 255 && !recovered_.front().empty())) {
      if (recovered_.front().empty()) {
        recovered_ = recover_response(bracket);
        log_.info("response: recovered from " + counted(bracket.size(), "photograph"));
      }
      return recovered_;
    }
    known_ = known_response(wanted_ == "linear" ? TransferFunction::linear : TransferFunction::srgb, max_code);
    log_.info(std::string("response: ") + (wanted_ == "linear" ? "linear" : "sRGB"));
    return known_;
  }

 private:
  std::string wanted_;
  Log& log_;
  LightOfCodes recovered_, known_;
};

void warn_of_clipping(const std::string& name, const RadianceMap& map, const Bracket& bracket, Log& log) {
  if (bracket.size() == 1)
    log.warn(name + ": one photograph holds far less range than light has; take a bracket, each 1/4 to 1/8 of the one before");
  if (map.clipped_share > 0)
    log.warn(
        name + ": " + fixed_text(100 * map.clipped_share, 3) +
        " % of the pixels are clipped even in the shortest photograph; add shorter exposures until nothing on the ball is white");
}

RadianceMap radiance_of_view(const MergeRequest& request, std::size_t view, ResponseFinder& responses, Log& log) {
  ViewPictures pictures = read_view(request.views[view], times_of(request, view));
  if (auto* image = std::get_if<Image>(&pictures)) return radiance_of(std::move(*image));
  const Bracket& bracket = std::get<Bracket>(pictures);
  RadianceMap map = merge_bracket(bracket, responses.of(bracket));
  warn_of_clipping(view_name(request, view), map, bracket, log);
  return map;
}

std::optional<CameraModel> camera_for(const MergeRequest& request, const Image& image, Log& log) {
  if (request.camera_file)
    return tracking::read_camera_file_for(*request.camera_file, "each photograph", image.width, image.height,
                                          [&](const std::string& warning) { log.warn(warning); });
  if (!request.fov_deg) return std::nullopt;
  return tracking::camera_from_field_of_view(image.width, image.height, *request.fov_deg);
}

void check_circle(const BallCircle& circle, const Image& image) {
  constexpr double kMinRadiusPx = 8;
  const glm::dvec2 low = circle.centre_px - circle.radius_px, high = circle.centre_px + circle.radius_px;
  if (circle.radius_px < kMinRadiusPx || low.x < -1 || low.y < -1 || high.x > image.width || high.y > image.height)
    throw UsageError("--ball " + fixed_text(circle.centre_px.x, 1) + "," + fixed_text(circle.centre_px.y, 1) + "," +
                     fixed_text(circle.radius_px, 1) + " does not lie in the picture of " + std::to_string(image.width) + " x " +
                     std::to_string(image.height) + " pixels, or is smaller than 8 pixels in radius");
}

BallView ball_in(const MergeRequest& request, std::size_t view, const Image& image, const std::optional<CameraModel>& camera,
                 Log& log) {
  if (!request.balls.empty()) check_circle(request.balls[view], image);
  const std::vector<glm::dvec2> outline =
      request.balls.empty() ? find_ball_outline(image, camera, view_name(request, view)) : outline_of(request.balls[view]);
  const BallView ball = camera ? BallView::perspective(*camera, outline) : BallView::orthographic(outline);
  std::string found = "ball at " + fixed_text(ball.circle().centre_px.x, 1) + "," + fixed_text(ball.circle().centre_px.y, 1) +
                      ", radius " + fixed_text(ball.circle().radius_px, 1) + " px";
  if (camera) found += ", " + fixed_text(ball.distance_radii(), 1) + " radii away";
  log.info(view_name(request, view) + ": " + found);
  return ball;
}

glm::dmat3 orientation_of(const MergeRequest& request, std::size_t view, const Image& image,
                          const std::optional<CameraModel>& camera, Log& log) {
  if (!request.tag) {
    return probe_from_camera(request.view_yaw_deg.empty() ? 0 : request.view_yaw_deg[view],
                             request.view_pitch_deg.empty() ? 0 : request.view_pitch_deg[view]);
  }
  const std::string name = view_name(request, view);
  const std::optional<TagSight> tag = find_tag(image, *camera, *request.tag);
  if (!tag)
    throw Error(name + ": the tag (" + request.tag->family + ", id " + std::to_string(request.tag->id) + ") was not found; " +
                instead_of_tag(image, *request.tag) + ". --view-yaw does without a tag");
  log.info(name + ": tag found, corners within " + fixed_text(tag->corner_sigma_px, 2) + " px");
  constexpr double kMaxAmbiguity = 0.05;
  if (tag->ambiguity > kMaxAmbiguity)
    log.warn(name + ": the tag is seen so that two poses explain it (the other one with " + fixed_text(100 * tag->ambiguity, 0) +
             " %); take it larger or more from the side");
  const glm::dmat3 probe_from_tag = glm::transpose(render::tag_from_probe(request.up, request.yaw_deg));
  return probe_from_tag * glm::transpose(tag->camera_from_tag.rotation);
}

void match_gain(BallPicture& picture, const BallPicture& first, double photographer_rad, const std::string& name, Log& log) {
  picture.gain = gain_between(first, picture, photographer_rad);
  const double ev = std::log2(picture.gain);
  log.info(name + ": brightened by " + fixed_text(ev, 2) + " EV to match the first view");
  constexpr double kMaxEv = 0.3;
  if (std::abs(ev) > kMaxEv)
    log.warn(name + ": " + fixed_text(ev, 2) +
             " EV apart from the first view; did the light change, or are views turned wrongly?");
}

void tell_losses(const AssembledProbe& assembled, Log& log) {
  log.info("hidden behind the ball: " + fixed_text(100 * assembled.blind_share, 2) +
           " % of all directions; photographer: " + fixed_text(100 * assembled.photographer_share, 2) + " %");
  constexpr double kMaxShare = 0.001;
  if (assembled.photographer_share > kMaxShare)
    log.warn(
        "the photographer and what is hidden behind the ball stay in the probe; a second view from 90 to 120 degrees around "
        "the ball removes both");
  if (assembled.clipped_sr > 0)
    log.warn("highlights are lost: " + plain_text(std::stod(fixed_text(1000 * assembled.clipped_sr, 3))) +
             " msr are only known to be at least as bright as written, and give at least " +
             fixed_text(100 * assembled.clipped_light, 1) + " % of all light");
}

int width_for(const std::vector<BallPicture>& views) {
  double radius_px = 0;
  for (const BallPicture& view : views) radius_px = std::max(radius_px, view.ball.circle().radius_px);
  // In the ball's middle a pixel is 2 / radius wide.
  return 2 * std::clamp(static_cast<int>(std::lround(std::numbers::pi * radius_px / 2)), 16, 4096);
}

}  // namespace

render::Probe merge_probe(const MergeRequest& request, Log& log) {
  check(request);
  const double photographer_rad = glm::radians(request.photographer_deg);
  ResponseFinder responses(request.response, log);
  std::vector<BallPicture> views;
  for (std::size_t i = 0; i < request.views.size(); ++i) {
    RadianceMap radiance = radiance_of_view(request, i, responses, log);
    const std::optional<CameraModel> camera = camera_for(request, radiance.image, log);
    const BallView ball = ball_in(request, i, radiance.image, camera, log);
    const glm::dmat3 orientation = orientation_of(request, i, radiance.image, camera, log);
    views.push_back({std::move(radiance), ball, orientation});
    if (i > 0) match_gain(views.back(), views.front(), photographer_rad, view_name(request, i), log);
  }
  const bool is_latlong = request.layout == render::ProbeLayout::latlong;
  AssembledProbe assembled =
      assemble_probe(views, is_latlong && request.width_px > 0 ? request.width_px : width_for(views), photographer_rad);
  tell_losses(assembled, log);
  Image& image = assembled.probe.image;
  for (std::size_t i = 0; i < image.data.size(); ++i)
    image.data[i] = static_cast<float>(image.data[i] / request.reflectance[static_cast<int>(i % 3)]);
  return is_latlong ? std::move(assembled.probe) : render::convert(assembled.probe, request.layout, request.width_px);
}

}  // namespace catchlight::app
