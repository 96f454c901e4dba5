#include "tests/app/window/driven_window.hpp"

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <numbers>
#include <sstream>

#include "catchlight/error.hpp"
#include "render/probe/probe.hpp"
#include "render/probe/probe_layouts.hpp"

namespace catchlight::app::testing {
namespace {

const std::string kDazzle = CATCHLIGHT_SOURCE_DIR "/recordings/dazzle/";

constexpr const char* kCamera = R"(%YAML:1.0
---
image_width: 320
image_height: 240
camera_matrix: !!opencv-matrix
   rows: 3
   cols: 3
   dt: d
   data: [ 310.0, 0., 159.5, 0., 310.0, 119.5, 0., 0., 1. ]
distortion_coefficients: !!opencv-matrix
   rows: 1
   cols: 5
   dt: d
   data: [ 0.02, 0., 0., 0., 0. ]
vignetting: [-0.3, 0., 0.]
)";

constexpr const char* kScene = R"(# A ball of metal under the sun, and a lamp beside it.

[tag]
family = "tag36h11"
id = 42
size_m = 0.08  # of the black square

[[tag.bundle]]
id = 43
tag_from_this = { translation_m = [0.5, 0, 0] }

[[object]]
mesh = "object.obj"

[probe]
image = "probe.exr"

[quality]
rays = 32
bands = 3
bounces = 1
light_samples = 8
samples = 2
reflection_rays = 4
receiver_points = 12
)";

constexpr const char* kMaterials = R"(newmtl metal
Kd 0.8 0.7 0.5
Pm 0.6
Pr 0.25
newmtl lamp
Kd 0.1 0.1 0.1
Ke 9 6 3
)";

/// A ball around (x, 0, 1.8 cm), as a grid from pole to pole; its vertices are numbered from `first`.
void add_ball(std::ostream& obj, const char* material, double x_m, double radius_m, int first) {
  constexpr int kRows = 12, kColumns = 16;
  for (int row = 0; row <= kRows; ++row)
    for (int column = 0; column <= kColumns; ++column) {
      const double down = std::numbers::pi * row / kRows, around = 2 * std::numbers::pi * column / kColumns;
      const double x = std::sin(down) * std::cos(around), y = std::sin(down) * std::sin(around), z = std::cos(down);
      obj << "v " << x_m + radius_m * x << ' ' << radius_m * y << ' ' << 0.018 + radius_m * z << "\nvn " << x << ' ' << y << ' '
          << z << '\n';
    }
  obj << "usemtl " << material << '\n';
  const auto corner = [&](int row, int column) {
    const std::string index = std::to_string(first + row * (kColumns + 1) + column);
    return ' ' + index + "//" + index;
  };
  for (int row = 0; row < kRows; ++row)
    for (int column = 0; column < kColumns; ++column)
      obj << 'f' << corner(row, column) << corner(row + 1, column) << corner(row + 1, column + 1) << corner(row, column + 1)
          << '\n';
}

std::string object() {
  std::ostringstream obj;
  obj << "mtllib object.mtl\n";
  add_ball(obj, "metal", 0, 0.015, 1);
  add_ball(obj, "lamp", 0.025, 0.006, 1 + 13 * 17);
  return obj.str();
}

}  // namespace

void make_small_recording(const tests::TemporaryFolder& folder) {
  folder.write("recording/camera.yaml", kCamera);
  folder.write("recording/scene.toml", kScene);
  folder.write("recording/object.obj", object());
  folder.write("recording/object.mtl", kMaterials);
  const render::Probe probe = render::load_probe(kDazzle + "probe.exr", {}, {});
  render::save_probe(folder.path("recording/probe.exr"), render::convert(probe, render::ProbeLayout::latlong, 64));
  const std::string command =
      "ffmpeg -v error -nostdin -i '" + kDazzle +
      "video.mp4' -frames:v 6 -vf scale=320:240:flags=area,gblur=sigma=0.7,noise=alls=6:allf=t:all_seed=7 -pix_fmt yuv420p "
      "-c:v libx264 -crf 8 -color_range tv -colorspace bt709 -color_trc bt709 -color_primaries bt709 '" +
      folder.path("recording/video.mp4") + "'";
  ASSERT_EQ(std::system(command.c_str()), 0) << command;
}

DrivenWindow::DrivenWindow(const std::string& recording, const RecordingOverrides& overrides)
    : surface_(make_headless_surface({800, 500})),
      window_(std::make_unique<TuneWindow>(*surface_, OpenedRecording{recording, overrides}, TuneState{})) {
  frame();
}

void DrivenWindow::frame() {
  window_->frame();
  ++frames_;
}

void DrivenWindow::draw(int frames) {
  for (int i = 0; i < frames; ++i) frame();
}

void DrivenWindow::run(const std::string& script) {
  UiScript steps("script", read_ui_script(scripts_.write("script.txt", script)));
  while (!steps.is_done()) {
    steps.before_frame(*window_);
    frame();
    if (!window_->is_idle()) surface_->rest(1.0 / 60);
  }
}

std::vector<unsigned char> DrivenWindow::picture() {
  run("wait\n");
  while (!window_->is_idle()) frame();
  return window_->shown()->composite.rgb;
}

void WindowTest::SetUpTestSuite() {
  folder_ = std::make_unique<tests::TemporaryFolder>();
  setenv("XDG_CACHE_HOME", folder_->path("cache").c_str(), 1);
  make_small_recording(*folder_);
}

}  // namespace catchlight::app::testing
