#include "bench/accuracy/clip.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <mutex>
#include <numbers>

namespace catchlight::tracking {
namespace {

constexpr double kFramesPerS = 24;
constexpr int kEasyFrames = 3, kRisingFrames = 3, kHardFrames = 8;

/// The stress between two, in every quantity.
Stress between(const Stress& easy, const Stress& hard, double share) {
  Stress mixed = hard;
  for (const auto value : {&Stress::size_px, &Stress::tilt_deg, &Stress::noise_codes, &Stress::blur_px, &Stress::motion_px,
                           &Stress::covered_percent, &Stress::contrast})
    mixed.*value = std::lerp(easy.*value, hard.*value, share);
  return mixed;
}

CameraModel stress_camera(const Stress& easy, const Stress& hard) {
  const double size_px = std::max(easy.size_px, hard.size_px);
  const int side_px = static_cast<int>(std::max(200.0, 2 * size_px)) + (hard.motion_px > 0 ? 160 : 0);
  CameraModel camera{side_px, side_px, 600, 600, side_px / 2.0 - 0.5, side_px / 2.0 - 0.5, {}};
  if (hard.k1 != 0) camera.fx_px = camera.fy_px = 0.75 * side_px;
  camera.distortion[0] = hard.k1;
  return camera;
}

/// A long bar in the picture, its end inside the tag, so deep that it covers the wanted share of the tag's square.
class Bar {
 public:
  Bar(const Corners& corners_px, const glm::dvec2& along, double side_px, double share)
      : corners_px_(corners_px), along_(along), half_width_px_(0.35 * side_px) {
    middle_px_ = (corners_px[0] + corners_px[1] + corners_px[2] + corners_px[3]) / 4.0;
    double outside = -2 * side_px, inside = 2 * side_px;
    for (int i = 0; i < 40; ++i) {
      end_px_ = (outside + inside) / 2;
      (covered_share() < share ? outside : inside) = end_px_;
    }
  }

  bool covers(const glm::dvec2& point_px) const {
    const glm::dvec2 from = point_px - middle_px_;
    return glm::dot(from, along_) < end_px_ && std::abs(from.x * along_.y - from.y * along_.x) < half_width_px_;
  }

 private:
  double covered_share() const {
    constexpr int kSteps = 64;
    int inside = 0;
    for (int i = 0; i < kSteps * kSteps; ++i) {
      const double u = (i % kSteps + 0.5) / kSteps, v = (i / kSteps + 0.5) / kSteps;
      inside += covers(glm::mix(glm::mix(corners_px_[0], corners_px_[1], u), glm::mix(corners_px_[3], corners_px_[2], u), v));
    }
    return static_cast<double>(inside) / (kSteps * kSteps);
  }

  Corners corners_px_;
  glm::dvec2 along_, middle_px_{0};
  double half_width_px_, end_px_ = 0;
};

void draw(const Bar& bar, double light_linear, SyntheticFrame& frame) {
  constexpr int kAcross = 4;
  for (int i = 0; i < frame.width_px * frame.height_px; ++i) {
    int hits = 0;
    for (int k = 0; k < kAcross * kAcross; ++k) {
      const glm::dvec2 within((k % kAcross + 0.5) / kAcross - 0.5, (k / kAcross + 0.5) / kAcross - 0.5);
      hits += bar.covers(glm::dvec2(i % frame.width_px, i / frame.width_px) + within);
    }
    float& pixel = frame.linear[static_cast<std::size_t>(i)];
    pixel = std::lerp(pixel, static_cast<float>(light_linear), static_cast<float>(hits) / (kAcross * kAcross));
  }
}

/// Makes light of shares of white.
void light(double contrast, SyntheticFrame& frame) {
  const double white_linear = std::min(0.6, 0.2 * std::sqrt(contrast)), black_linear = white_linear / contrast;
  for (float& pixel : frame.linear) pixel = static_cast<float>(std::lerp(black_linear, white_linear, static_cast<double>(pixel)));
}

/// Share of the print's white in each pixel (the ground has some too): the mean of pictures along the way, which is what a
/// shutter makes. Neighbours are close enough that the lens's blur hides the steps.
std::vector<float> render_smeared(SyntheticScene scene, const glm::dvec2& smear_px) {
  constexpr double kStepPx = 1.25;
  const int steps = static_cast<int>(std::ceil(glm::length(smear_px) / kStepPx)) + 1;
  glm::dvec3& translation_m = scene.tags[0].camera_from_tag.translation_m;
  const glm::dvec3 middle_m = translation_m;
  std::vector<float> mean;
  for (int i = 0; i < steps; ++i) {
    const glm::dvec2 off_px = ((i + 0.5) / steps - 0.5) * smear_px;
    translation_m = middle_m + middle_m.z * glm::dvec3(off_px.x / scene.camera.fx_px, off_px.y / scene.camera.fy_px, 0);
    const SyntheticFrame frame = render(scene);
    mean.resize(frame.linear.size());
    for (std::size_t k = 0; k < mean.size(); ++k) mean[k] += frame.linear[k] / static_cast<float>(steps);
  }
  return mean;
}

/// The same scene comes again under other light, noise and cover; rendering is what takes the time.
std::vector<float> render_once(const SyntheticScene& scene, const glm::dvec2& smear_px) {
  static std::mutex mutex;
  static std::map<std::vector<double>, std::vector<float>> known;
  const RigidTransform& pose = scene.tags[0].camera_from_tag;
  std::vector<double> key{scene.blur_px, smear_px.x, smear_px.y, scene.camera.fx_px, scene.camera.distortion[0]};
  for (int i = 0; i < 3; ++i) key.insert(key.end(), {pose.rotation[0][i], pose.rotation[1][i], pose.translation_m[i]});
  key.push_back(scene.camera.width_px);
  {
    const std::lock_guard lock(mutex);
    if (const auto found = known.find(key); found != known.end()) return found->second;
  }
  std::vector<float> white_share = render_smeared(scene, smear_px);
  const std::lock_guard lock(mutex);
  return known[key] = std::move(white_share);
}

/// How one clip moves, drawn once.
struct Motion {
  glm::dvec2 start_px, drift_px;
  double tilt_direction_deg, turn_deg, turn_rate_deg;
  glm::dvec2 smear_direction, bar_direction;

  Motion(std::mt19937& random, const CameraModel& camera, const Stress& hard) {
    const auto direction = [&] {
      const double angle = uniform(random, 0, 2 * std::numbers::pi);
      return glm::dvec2(std::cos(angle), std::sin(angle));
    };
    start_px = glm::dvec2(camera.cx_px, camera.cy_px) + direction() * uniform(random, 0, 6);
    if (hard.k1 != 0) start_px += direction() * (0.5 * camera.cx_px);
    drift_px = direction() * uniform(random, 0.3, 0.8);
    tilt_direction_deg = uniform(random, -180, 180);
    turn_deg = uniform(random, -180, 180);
    turn_rate_deg = uniform(random, -1, 1);
    smear_direction = direction();
    bar_direction = direction();
  }
};

SyntheticScene scene_of(const Stress& stress, const CameraModel& camera, const Motion& motion, const glm::dvec2& center_px,
                        int frame) {
  SyntheticScene scene;
  scene.camera = camera;
  scene.tags.resize(1);
  scene.blur_px = stress.blur_px;
  scene.white_linear = 1;
  scene.black_linear = 0;
  scene.background_linear = 0.4;
  scene.tags[0].camera_from_tag = tag_pose(camera, center_px, camera.fx_px * scene.tags[0].target.size_m / stress.size_px,
                                           {stress.tilt_deg, 0, motion.tilt_direction_deg});
  // The tag turns in its own plane: its tilt stays what it is meant to be.
  const double turn = glm::radians(motion.turn_deg + motion.turn_rate_deg * frame);
  glm::dmat3 spin(1.0);
  spin[0] = {std::cos(turn), std::sin(turn), 0};
  spin[1] = {-std::sin(turn), std::cos(turn), 0};
  scene.tags[0].camera_from_tag.rotation = scene.tags[0].camera_from_tag.rotation * spin;
  return scene;
}

}  // namespace

double uniform(std::mt19937& random, double low, double high) {
  return low + (high - low) * (static_cast<double>(random()) / 4294967296.0);
}

Clip stress_clip(const Stress& easy, const Stress& hard, unsigned seed) {
  std::mt19937 random(seed);
  Clip clip{stress_camera(easy, hard), {}, {}};
  const Motion motion(random, clip.camera, hard);
  glm::dvec2 center_px = motion.start_px;
  // A smeared tag crosses the picture, half of its way on either side of the middle.
  center_px -= motion.smear_direction * (hard.motion_px * (0.5 * kRisingFrames + kHardFrames));
  for (int k = 0; k < kEasyFrames + kRisingFrames + kHardFrames; ++k) {
    const double share = std::clamp((k - kEasyFrames + 1) / (kRisingFrames + 1.0), 0.0, 1.0);
    const Stress now = between(easy, hard, share);
    center_px += motion.drift_px + 2 * now.motion_px * motion.smear_direction;
    const SyntheticScene scene = scene_of(now, clip.camera, motion, center_px, k);
    SyntheticFrame picture{
        clip.camera.width_px, clip.camera.height_px, render_once(scene, now.motion_px * motion.smear_direction), {}};
    light(now.contrast, picture);
    if (now.covered_percent > 0) {
      const Bar bar(true_corners_px(clip.camera, scene.tags[0]), motion.bar_direction, now.size_px, now.covered_percent / 100);
      draw(bar, now.bar_linear, picture);
    }
    picture.codes = expose(picture.linear, now.noise_codes, seed * 100 + static_cast<unsigned>(k) + 1);
    clip.frames.push_back({std::move(picture), k / kFramesPerS, scene.tags[0].camera_from_tag, k >= kEasyFrames + kRisingFrames});
  }
  return clip;
}

Clip still_clip(double size_px, double noise_codes, int seeds, unsigned seed) {
  std::mt19937 random(seed);
  Stress stress;
  stress.size_px = size_px;
  Clip clip{stress_camera(stress, stress), {}, {}};
  const Motion motion(random, clip.camera, stress);
  const SyntheticScene scene = scene_of(stress, clip.camera, motion, motion.start_px, 0);
  SyntheticFrame picture = render(scene);
  light(stress.contrast, picture);
  for (int k = 0; k < seeds; ++k) {
    clip.frames.push_back({picture, k / kFramesPerS, scene.tags[0].camera_from_tag, true});
    clip.frames.back().picture.codes = expose(picture.linear, noise_codes, seed * 1000 + static_cast<unsigned>(k) + 1);
  }
  return clip;
}

Clip frontal_clip(unsigned seed) {
  std::mt19937 random(seed);
  Clip clip{{200, 160, 1000, 1000, 99.5, 79.5, {}}, {}, {}};
  const double size_px = uniform(random, 30, 60), tilt_deg = uniform(random, 0, 15);
  const double tilt_direction = uniform(random, 0, 2 * std::numbers::pi);
  std::array<double, 6> amplitude{}, frequency_hz{}, phase{};
  for (int i = 0; i < 6; ++i) {
    amplitude[i] = uniform(random, 0.3, 1);
    frequency_hz[i] = uniform(random, 0.1, 0.5);
    phase[i] = uniform(random, 0, 2 * std::numbers::pi);
  }
  for (int k = 0; k < 48; ++k) {
    const double time_s = k / kFramesPerS;
    const auto sway = [&](int i) { return amplitude[i] * std::sin(2 * std::numbers::pi * frequency_hz[i] * time_s + phase[i]); };
    glm::dvec2 tilt =
        tilt_deg * glm::dvec2(std::cos(tilt_direction), std::sin(tilt_direction)) + 4.0 * glm::dvec2(sway(0), sway(1));
    if (glm::length(tilt) > 15) tilt *= 15 / glm::length(tilt);
    SyntheticScene scene;
    scene.camera = clip.camera;
    scene.tags.resize(1);
    scene.blur_px = 0.7;
    scene.noise_codes = 3;
    scene.seed = seed * 1000 + static_cast<unsigned>(k) + 1;
    scene.tags[0].camera_from_tag = tag_pose(clip.camera, {99.5 + 15 * sway(2), 79.5 + 15 * sway(3)},
                                             1000 * 0.08 / size_px * (1 + 0.05 * sway(4)), {tilt.x, tilt.y, 20 * sway(5)});
    clip.frames.push_back({render(scene), time_s, scene.tags[0].camera_from_tag, true});
  }
  return clip;
}

}  // namespace catchlight::tracking
