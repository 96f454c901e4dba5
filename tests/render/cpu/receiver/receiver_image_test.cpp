#include "render/cpu/receiver/receiver_image.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "render/camera/clip_from_camera.hpp"
#include "render/cpu/plate/layer_blur.hpp"
#include "render/mesh/bounds.hpp"
#include "render/transfer/transfer.hpp"
#include "tests/support/shapes.hpp"

namespace catchlight::render {
namespace {

/// A box under one lamp, seen from above: a shadow with sharp edges within a frame that it does not fill.
class ReceiverImage : public ::testing::Test {
 protected:
  ReceiverImage() {
    transfer_ = bake_transfer(mesh_, {.min_m = glm::vec2(-0.1f), .max_m = glm::vec2(0.1f), .columns = 21, .rows = 21},
                              {.bands = 3, .rays = 64}, {});
    const std::vector<LightSample> lamps{{glm::normalize(glm::dvec3(0.4, 0.3, 1)), {1, 2, 3}}};
    light_.whole = light_.split_off = project_to_sh(lamps, 3);
    light_.samples = lamps;
    shadow_.update(light_, true);
    view_.camera = {.width_px = 203, .height_px = 150, .fx_px = 220, .fy_px = 220, .cx_px = 101, .cy_px = 74.5};
    view_.has_pose = true;
    view_.camera_from_tag = look_down(0.5);
  }

  static RigidTransform look_down(double height_m) { return {glm::dmat3(1, 0, 0, 0, -1, 0, 0, 0, -1), {0, 0, height_m}}; }

  FramePlan plan() const {
    FramePlan plan;
    plan.frame = plan.virtual_rect = {0, 0, view_.camera.width_px, view_.camera.height_px};
    plan.draws_receiver = true;
    plan.blur = blur_;
    plan.distortion_limit = distortion_limit(view_.camera);
    return plan;
  }

  /// What the pixel's middle sees, by hand.
  glm::vec3 direct(int x, int y) const {
    const CameraModel& c = view_.camera;
    const glm::dvec2 place =
        glm::dvec2((x - c.cx_px) / c.fx_px, -(y - c.cy_px) / c.fy_px) * view_.camera_from_tag.translation_m.z;
    return shadow_.ratio(place);
  }

  void draw(render::ReceiverImage& image) {
    rays_of_.set_camera(view_.camera, plan().distortion_limit);
    image.draw(view_, plan(), rays_of_, shadow_);
  }

  /// All pixels, read `piece` at a time.
  Image read(const render::ReceiverImage& image, int piece) const {
    Image result(view_.camera.width_px, view_.camera.height_px, 4);
    std::vector<float> planes[3];
    for (auto& plane : planes) plane.resize(static_cast<std::size_t>(piece));
    for (int y = 0; y < result.height; ++y)
      for (int x = 0; x < result.width; x += piece) {
        const int count = std::min(piece, result.width - x);
        image.read_row(x, y, count, {planes[0].data(), planes[1].data(), planes[2].data()});
        for (int i = 0; i < count; ++i)
          for (int c = 0; c < 3; ++c) result.pixel(x + i, y)[c] = planes[c][static_cast<std::size_t>(i)];
      }
    return result;
  }

  Mesh mesh_ = box({-0.03f, -0.02f, 0.001f}, {0.02f, 0.04f, 0.05f});
  RayScene rays_{mesh_};
  Bounds bounds_ = bounds_of(mesh_);
  Transfer transfer_;
  SplitLight light_;
  ReceiverShadow shadow_{transfer_, rays_, bounds_};
  FrameView view_;
  CameraBlurPlan blur_;
  PixelRays rays_of_;
};

TEST_F(ReceiverImage, IsTheRatioOfWhatEachPixelSees) {
  render::ReceiverImage image;
  draw(image);
  const Image read_ratio = read(image, 128);
  int exact = 0, dark = 0;
  for (int y = 0; y < read_ratio.height; ++y)
    for (int x = 0; x < read_ratio.width; ++x) {
      const glm::vec3 expected = direct(x, y);
      dark += expected.y < 0.5f;
      float most = 0;
      for (int c = 0; c < 3; ++c) most = std::max(most, std::abs(read_ratio.pixel(x, y)[c] - expected[c]));
      exact += most < 1e-5f;
      ASSERT_LE(most, 0.01f) << x << ", " << y << ": a cell whose corners differ by no more is interpolated";
    }
  EXPECT_GT(dark, 500);
  EXPECT_GT(exact, 20000);
}

TEST_F(ReceiverImage, BehindALensThatBendsFillsTheFrame) {
  view_.camera.distortion = {-0.2, 0.05, 0, 0, 0, 0, 0, 0};
  view_.camera_from_tag = look_down(0.08);
  render::ReceiverImage image;
  draw(image);
  const Image read_ratio = read(image, 128);
  const auto place = [&](int x, int y) { return view_.camera_from_tag.translation_m.z * glm::dvec2(rays_of_.at(x, y)); };
  for (int y = 0; y < read_ratio.height; ++y)
    for (int x = 0; x < read_ratio.width; ++x) {
      const glm::vec3 expected = shadow_.ratio(place(x, y) * glm::dvec2(1, -1));
      for (int c = 0; c < 3; ++c) ASSERT_NEAR(read_ratio.pixel(x, y)[c], expected[c], 0.01f) << x << ", " << y;
    }
}

TEST_F(ReceiverImage, IsTheSameInAnyPieces) {
  render::ReceiverImage image;
  draw(image);
  const Image whole = read(image, 300);
  for (const int piece : {1, 7, 128}) EXPECT_EQ(read(image, piece).data, whole.data) << piece;
}

TEST_F(ReceiverImage, BlurredIsWhatABlurOfAllPixelsGives) {
  render::ReceiverImage image;
  // Another frame before, larger in the picture: its pixels lie in the memory still.
  view_.camera_from_tag = look_down(0.25);
  draw(image);
  view_.camera_from_tag = look_down(0.5);
  blur_.variance_px2 = 2;
  blur_.moves = true;
  blur_.shadow.displacement_px = {9, 4};
  draw(image);

  const auto blur = [&](Image& pixels, std::span<const PixelRect> active, const glm::dvec2& corner) {
    LayerBlur layer_blur;
    layer_blur.defocus(pixels, active, discrete_gaussian(2, 2e-3));
    layer_blur.move(pixels, {0, 0, pixels.width, pixels.height}, blur_.shadow, corner);
  };
  Image all(view_.camera.width_px, view_.camera.height_px, 4);
  for (int y = 0; y < all.height; ++y)
    for (int x = 0; x < all.width; ++x)
      for (int c = 0; c < 3; ++c) all.pixel(x, y)[c] = direct(x, y)[c];
  const PixelRect whole{0, 0, all.width, all.height};
  blur(all, {&whole, 1}, glm::dvec2(0));
  blur(image.pixels(), image.sharp(), glm::dvec2(image.rect().x, image.rect().y));
  const Image found = read(image, 128);
  double worst = 0;
  for (int y = 0; y < all.height; ++y)
    for (int x = 0; x < all.width; ++x)
      for (int c = 0; c < 3; ++c) worst = std::max(worst, std::abs(double{found.pixel(x, y)[c]} - all.pixel(x, y)[c]));
  EXPECT_LT(worst, 0.01) << "as much as interpolated cells may differ";
}

/// A shadow that is as deep as that everywhere begins at the very rim of what can be seen of it.
TEST_F(ReceiverImage, AnEdgeAtTheReachsRimStaysSharp) {
  const PlaneRect reach = shadow_.reach();
  ASSERT_LT(reach.max_m.x - reach.min_m.x, 0.2f) << "no more than the shadow and a texel around it";
  render::ReceiverImage image;
  for (const double height_m : {0.3, 0.33, 0.37, 0.42, 0.5}) {
    view_.camera_from_tag = look_down(height_m);
    draw(image);
    const Image ratio = read(image, 128);
    for (int y = 0; y < ratio.height; ++y)
      for (int x = 0; x < ratio.width; ++x) ASSERT_NEAR(ratio.pixel(x, y)[1], direct(x, y).y, 0.02) << x << ", " << y;
  }
}

TEST_F(ReceiverImage, FromBelowThereIsNoShadow) {
  render::ReceiverImage image;
  draw(image);
  FramePlan below = plan();
  below.draws_receiver = false;
  image.draw(view_, below, rays_of_, shadow_);
  const Image ratio = read(image, 50);
  for (std::size_t i = 0; i < ratio.data.size(); ++i) {
    if (i % 4 != 3) {
      ASSERT_EQ(ratio.data[i], 1);
    }
  }
  EXPECT_TRUE(image.sharp().empty());
}

}  // namespace
}  // namespace catchlight::render
