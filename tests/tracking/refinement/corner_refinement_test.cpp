// Refined corners against the exact corners of rendered tags.
#include "tracking/refinement/corner_refinement.hpp"
#include "catchlight/camera.hpp"
#include "catchlight/color.hpp"
#include "catchlight/luma_view.hpp"
#include "catchlight/tag.hpp"
#include "tests/support/synthetic_tag.hpp"
#include "tracking/detection/detector.hpp"
#include "tracking/detection/families.hpp"

#include <gtest/gtest.h>

namespace catchlight::tracking {
namespace {

SyntheticScene one_tag(const CameraModel& camera, double distance_m, const glm::dvec3& turn_deg) {
  SyntheticScene scene;
  scene.camera = camera;
  scene.tags.resize(1);
  scene.tags[0].camera_from_tag = tag_pose(camera, {300.3, 221.8}, distance_m, turn_deg);
  return scene;
}

Quad truth(const SyntheticScene& scene) {
  return true_corners_px(scene.camera, scene.tags[0]);
}

RefinedCorners refine(const SyntheticScene& scene, const SyntheticFrame& frame, const Quad& from) {
  const TagTarget& target = scene.tags[0].target;
  return refine_corners(frame.luma(), scene.camera, from, tag_layout(target.family, target.id));
}

/// The quad as far off as detectors are: 0.3 px inside, and some noise.
Quad disturbed(const Quad& quad) {
  const glm::dvec2 center = (quad[0] + quad[1] + quad[2] + quad[3]) / 4.0;
  const glm::dvec2 noise[] = {{0.1, -0.05}, {-0.08, -0.12}, {0.02, 0.1}, {-0.1, 0.06}};
  Quad result;
  for (int i = 0; i < 4; ++i) result[i] = quad[i] + 0.3 * glm::normalize(center - quad[i]) + noise[i];
  return result;
}

bool all_refined(const RefinedCorners& refined) {
  return std::all_of(refined.edge_refined.begin(), refined.edge_refined.end(), [](bool b) { return b; });
}

TEST(CornerRefinement, FindsExactCornersWithoutNoise) {
  // What is left is 8-bit quantisation and the 1/8 px grid of the renderer's rays.
  for (const glm::dvec3& turn_deg :
       {glm::dvec3(0, 0, 7), glm::dvec3(40, 10, 20), glm::dvec3(-30, 50, 120), glm::dvec3(65, 0, 45)}) {
    const SyntheticScene scene = one_tag(plain_camera(), 0.4, turn_deg);
    const RefinedCorners refined = refine(scene, render(scene), disturbed(truth(scene)));
    EXPECT_TRUE(all_refined(refined));
    EXPECT_LT(rms_distance(refined.corners_px, truth(scene)), 0.01) << turn_deg.x << ", " << turn_deg.y;
    EXPECT_NEAR(outward_bias_px(refined.corners_px, truth(scene)), 0, 0.005) << turn_deg.x << ", " << turn_deg.y;
  }
}

TEST(CornerRefinement, MeasuresTheBlur) {
  const SyntheticScene scene = one_tag(plain_camera(), 0.4, {20, 10, 30});
  const RefinedCorners refined = refine(scene, render(scene), truth(scene));
  // The pixel's own square adds a variance of 1/12.
  for (const double blur_px : refined.edge_blur_px) EXPECT_NEAR(blur_px, std::hypot(scene.blur_px, std::sqrt(1 / 12.0)), 0.02);
}

TEST(CornerRefinement, FollowsTheEdgesOfADistortedImage) {
  SyntheticScene scene = one_tag(distorted_camera(), 0.25, {25, -20, 15});
  scene.tags[0].camera_from_tag = tag_pose(scene.camera, {180, 330}, 0.25, {25, -20, 15});
  const RefinedCorners refined = refine(scene, render(scene), disturbed(truth(scene)));
  EXPECT_TRUE(all_refined(refined));
  EXPECT_LT(rms_distance(refined.corners_px, truth(scene)), 0.01);

  // Taken as straight, the same edges miss by far: the lens cannot be left out.
  CameraModel straight = scene.camera;
  straight.distortion = {};
  const auto ignoring = refine_corners(render(scene).luma(), straight, disturbed(truth(scene)), tag_layout("tag36h11", 0));
  EXPECT_GT(rms_distance(ignoring.corners_px, truth(scene)), 0.1);
}

TEST(CornerRefinement, ErrorOnALadderOfNoiseAndSize) {
  // Limits are 1.5 times a first principle: an edge of n pixels, noise s and step c is placed to
  // (s/c)·√(2√π·blur·4/n) at its ends; a corner has two of them. Noise is largest, in light, on the white side.
  for (const double distance_m : {0.3, 0.6, 1.2})  // 160, 80 and 40 px
    for (const double noise_codes : {1.0, 3.0, 8.0}) {
      SyntheticScene scene = one_tag(plain_camera(), distance_m, {30, 20, 10});
      const SyntheticFrame clean = render(scene);
      double squares = 0;
      constexpr int kSeeds = 8;
      for (unsigned seed = 1; seed <= kSeeds; ++seed) {
        SyntheticFrame frame = clean;
        frame.codes = expose(clean.linear, noise_codes, seed);
        squares += std::pow(rms_distance(refine(scene, frame, disturbed(truth(scene))).corners_px, truth(scene)), 2);
      }
      const double rms_px = std::sqrt(squares / kSeeds);
      const double white_code = srgb_from_linear(scene.white_linear);
      const double noise_linear = linear_from_srgb(white_code + noise_codes / 255) - scene.white_linear;
      const double edge_px = 48.0 / distance_m * 0.8;
      const double expected_px = noise_linear / 0.57 * std::sqrt(2 * std::sqrt(M_PI) * 0.67 * 4 / edge_px) * std::sqrt(2.0);
      std::cout << edge_px << " px, noise " << noise_codes << ": rms " << rms_px << " px, expected " << expected_px << "\n";
      EXPECT_LT(rms_px, 1.5 * expected_px + 0.005) << edge_px << " px, noise " << noise_codes;
    }
}

TEST(CornerRefinement, KeepsTheGivenCornersWhereThereIsNoEdge) {
  const SyntheticScene scene = one_tag(plain_camera(), 0.4, {20, 10, 30});
  SyntheticFrame frame = render(scene);
  std::fill(frame.codes.begin(), frame.codes.end(), std::uint8_t{90});
  const Quad given = disturbed(truth(scene));
  const RefinedCorners refined = refine(scene, frame, given);
  for (const bool edge : refined.edge_refined) EXPECT_FALSE(edge);
  EXPECT_LT(rms_distance(refined.corners_px, given), 1e-9);
}

TEST(CornerRefinement, RefusesEdgesOfTheWrongPolarity) {
  const SyntheticScene scene = one_tag(plain_camera(), 0.4, {20, 10, 30});
  SyntheticFrame frame = render(scene);
  for (auto& code : frame.codes) code = static_cast<std::uint8_t>(255 - code);
  for (const bool edge : refine(scene, frame, truth(scene)).edge_refined) EXPECT_FALSE(edge);
}

TEST(CornerRefinement, AHiddenEdgeLeavesTheOthersExact) {
  const SyntheticScene scene = one_tag(plain_camera(), 0.4, {0, 0, 0});
  SyntheticFrame frame = render(scene);
  const Quad exact = truth(scene);
  // Something grey covers the bottom edge (from corner 0 to corner 1) from end to end.
  for (int y = static_cast<int>(exact[0].y) - 8; y < static_cast<int>(exact[0].y) + 9; ++y)
    std::fill_n(&frame.codes[static_cast<std::size_t>(y * frame.width_px)], frame.width_px, std::uint8_t{120});
  const RefinedCorners refined = refine(scene, frame, exact);
  EXPECT_EQ(refined.edge_refined, (std::array<bool, 4>{false, true, true, true}));
  EXPECT_LT(glm::distance(refined.corners_px[2], exact[2]), 0.02);
  EXPECT_LT(glm::distance(refined.corners_px[3], exact[3]), 0.02);
}

TEST(CornerRefinement, StaysInsideTheImage) {
  // The quad's lower edge is a pixel from the image's border, its quiet zone cut off: no read beyond it (ASan), no throw.
  SyntheticScene scene = one_tag(plain_camera(), 0.4, {0, 0, 0});
  scene.tags[0].camera_from_tag = tag_pose(scene.camera, {60.5, 418.0}, 0.4, {0, 0, 0});
  const RefinedCorners refined = refine(scene, render(scene), truth(scene));
  EXPECT_TRUE(refined.edge_refined[2]);
  for (const glm::dvec2& corner : refined.corners_px) EXPECT_TRUE(std::isfinite(corner.x + corner.y));
}

TEST(CornerRefinement, LimitedRangeLumaIsReadAsSuch) {
  const SyntheticScene scene = one_tag(plain_camera(), 0.4, {40, 10, 20});
  const SyntheticFrame frame = render(scene);
  std::vector<std::uint8_t> limited;
  for (const float light : frame.linear)
    limited.push_back(static_cast<std::uint8_t>(std::lround(16 + 219 * srgb_from_linear(light))));
  const LumaView luma{limited.data(), frame.width_px, frame.height_px, frame.width_px, 16, 235};
  const auto refined = refine_corners(luma, scene.camera, disturbed(truth(scene)), tag_layout("tag36h11", 0));
  EXPECT_LT(rms_distance(refined.corners_px, truth(scene)), 0.01);
}

class RefinesFamily : public ::testing::TestWithParam<std::string> {};

TEST_P(RefinesFamily, FromDetectionToAHundredthOfAPixel) {
  SyntheticScene scene = one_tag(plain_camera(), 0.35, {35, -15, 25});
  scene.tags[0].target = {{GetParam(), 3, 0.08}, {}};
  const SyntheticFrame frame = render(scene);
  TrackerOptions options;
  options.max_hamming = 0;  // quick to set up, and the print is clean
  const auto found = Detector(GetParam(), options).detect(frame.luma());
  ASSERT_EQ(found.size(), 1u);
  EXPECT_EQ(found[0].id, 3);
  const RefinedCorners refined = refine(scene, frame, found[0].corners_px);
  EXPECT_TRUE(all_refined(refined));
  EXPECT_LT(rms_distance(refined.corners_px, truth(scene)), 0.01);
}

INSTANTIATE_TEST_SUITE_P(Library, RefinesFamily, ::testing::ValuesIn(tag_families()),
                         [](const auto& family) { return family.param; });

}  // namespace
}  // namespace catchlight::tracking
