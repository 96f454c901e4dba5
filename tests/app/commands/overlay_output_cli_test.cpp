// What overlay and other commands write, and what they refuse before they begin.
#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <opencv2/imgcodecs.hpp>

#include "tests/app/commands/overlay_command.hpp"
#include "tests/support/layers_file.hpp"

namespace catchlight::tests {
namespace {

namespace fs = std::filesystem;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

/// Every channel is rounded to half of its own: by 2^-11 of its value, and 2^-25 near 0.
void expect_recomposed(const LayersFile& file) {
  const Image recomposed = recompose(file.layers);
  for (int y = 0; y < recomposed.height; ++y)
    for (int x = 0; x < recomposed.width; ++x) {
      const float* object = file.layers.object.pixel(x, y);
      for (int c = 0; c < 3; ++c) {
        const double value = file.rgba.pixel(x, y)[c], plate = file.layers.plate.pixel(x, y)[c],
                     shadow = file.layers.shadow.pixel(x, y)[c], glare = file.layers.glare.pixel(x, y)[c];
        const double error = std::ldexp(std::abs(value) + (2 + object[3]) * plate * shadow + std::abs(object[c]) + glare, -11);
        ASSERT_NEAR(recomposed.pixel(x, y)[c], value, 1.01 * error + 1e-6) << x << ", " << y;
      }
    }
}

void expect_depth_where_an_object_is(const LayersFile& file) {
  for (std::size_t i = 0; i < file.matte.data.size(); ++i)
    ASSERT_EQ(std::isfinite(file.layers.depth.data[i]), file.layers.object.data[4 * i + 3] > 0) << i;
}

TEST_F(OverlayCommand, ExrLayersRecomposeToTheComposite) {
  const std::string copy = copied_recording(2, "dazzle"), poses = read_text(recording("dazzle") + "/poses.csv");
  // Without the second frame's pose.
  const std::string track = folder_.write("track.csv", poses.substr(0, poses.find('\n', poses.find('\n') + 1) + 1));
  ASSERT_EQ(overlay(copy, folder_.path("layers.%04d.exr"), {"--track", track}).exit_code, 0);
  run_shell("ffmpeg -v error -nostdin -i " + folder_.path("layers.0000.exr") + " " + folder_.path("composite.png"));
  EXPECT_FALSE(cv::imread(folder_.path("composite.png")).empty());

  const LayersFile posed = read_layers(folder_.path("layers.0000.exr")), unposed = read_layers(folder_.path("layers.0001.exr"));
  EXPECT_GT(*std::ranges::max_element(posed.layers.glare.data), 0.01f);
  EXPECT_LT(*std::ranges::min_element(posed.layers.shadow.data), 0.9f);
  EXPECT_EQ(*std::ranges::max_element(posed.matte.data), 1.0f);
  EXPECT_EQ(*std::ranges::max_element(unposed.matte.data), 0.0f);
  for (const LayersFile* file : {&posed, &unposed}) {
    expect_recomposed(*file);
    expect_depth_where_an_object_is(*file);
  }
}

TEST_F(OverlayCommand, EveryLayerOfABlurredFrameIsBlurredAsTheObject) {
  const std::string copy = copied_recording(2, "dazzle");
  const std::vector<std::string> blur = {"--lens.motion_blur", "true", "--lens.shutter", "1", "--lens.defocus", "true"};
  ASSERT_EQ(overlay(copy, folder_.path("layers.%04d.exr"), blur).exit_code, 0);
  const LayersFile file = read_layers(folder_.path("layers.0001.exr"));
  expect_recomposed(file);
  expect_depth_where_an_object_is(file);
  int partly = 0;
  for (std::size_t i = 0; i < file.matte.data.size(); ++i) {
    partly += file.matte.data[i] > 0 && file.matte.data[i] < 1;
    for (std::size_t c = 0; c < 3; ++c)  // what is mirrored is a part of the object's light; both are rounded to halves
      ASSERT_LE(file.layers.reflection.data[3 * i + c], 1.001f * file.layers.object.data[4 * i + c] + 1e-5f) << i;
  }
  EXPECT_GT(partly, 1500) << "the outline is blurred over some pixels";
}

TEST_F(OverlayCommand, ExistingOutputsAreKeptWithoutY) {
  const std::string copy = copied_recording(1);
  std::ofstream(out_) << "precious";
  EXPECT_EQ(overlay(copy, out_).exit_code, 2);
  EXPECT_EQ(read_text(out_), "precious");
  EXPECT_EQ(overlay(copy, out_, {"-y"}).exit_code, 0);
  EXPECT_NE(read_text(out_), "precious");
}

/// The mesh is read after the footage is tracked: whatever is said before it is said before the work.
TEST_F(OverlayCommand, WhatStandsInTheWayOfAnOutputIsNoticedBeforeTheWork) {
  const std::string copy = copied_recording(3);
  std::ofstream(copy + "/object.glb") << "no mesh";
  for (const char* taken : {"comp.0001.png", "layers.0002.exr", "taken.json", "taken.csv"})
    std::ofstream(folder_.path(taken)) << "precious";
  fs::create_directories(folder_.path("folder.mp4"));
  const std::string comp = folder_.path("comp.%04d.png"), layers = folder_.path("layers.%04d.exr");
  const auto refused = [&](const std::string& output, const std::vector<std::string>& options, const std::string& named) {
    const CommandResult result = overlay(copy, output, options);
    EXPECT_THAT(result.error, AllOf(HasSubstr(named), Not(HasSubstr("object.glb"))));
    EXPECT_NE(result.exit_code, 0);
  };
  refused(comp, {}, "comp.0001.png: exists already; pass -y");
  refused(layers, {}, "layers.0002.exr: exists already; pass -y");
  refused(layers, {"--frames", "2:"}, "layers.0002.exr: exists already");
  refused(folder_.path("none/%04d.exr"), {}, "there is no folder");
  refused("/proc/%04d.exr", {}, "/proc/0000.exr: cannot write into its folder");
  refused("/proc/%04d.png", {}, "/proc/0000.png: cannot write into its folder");
  refused("/proc/out.mp4", {}, "/proc/out.mp4: cannot write into its folder");
  refused(folder_.path("folder.mp4"), {"-y"}, "folder.mp4: is a folder");
  refused(out_, {"--report", folder_.path("taken.json")}, "taken.json: exists already");
  refused(out_, {"--report", "/proc/report.json"}, "/proc/report.json: cannot write into its folder");
  refused(out_, {"--track-out", folder_.path("taken.csv")}, "taken.csv: exists already");
  refused(out_, {"--track-out", "/proc/track.csv"}, "/proc/track.csv: cannot write into its folder");
  // What does not stand in the way.
  EXPECT_THAT(overlay(copy, layers, {"--frames", "0:2"}).error, HasSubstr("object.glb"));
  EXPECT_THAT(overlay(copy, layers, {"-y"}).error, HasSubstr("object.glb"));
}

/// Nor the files of the recording, where -y is given.
TEST_F(OverlayCommand, NoOutputTakesTheNameOfAnotherOrOfAnInput) {
  const std::string copy = copied_recording(1), scene = copy + "/scene.toml", before = read_text(scene);
  const std::string taken = folder_.path("same.csv"), probe = copy + "/probe.exr", probe_before = read_text(probe);
  expect_refused(overlay(copy, out_, {"--report", taken, "--track-out", taken}), out_, {"same.csv: is named for two outputs"}, 2);
  expect_refused(overlay(copy, out_, {"-y", "--report", scene}), out_, {"scene.toml' is the input itself"}, 2);
  expect_refused(run_catchlight({"track", copy, "-o", taken, "--report", taken}), taken, {"is named for two outputs"}, 2);
  const std::vector<std::vector<std::string>> onto_probe{{"reference", copy, "--frame", "0", "-o", probe, "-y"},
                                                         {"probe", "convert", probe, probe, "--layout", "latlong", "-y"},
                                                         {"probe", "sh", probe, "-o", probe, "-y"},
                                                         {"probe", "split", probe, "--rest", probe, "-y"},
                                                         {"glare", "--aperture", probe, "-o", probe, "-y"},
                                                         {"probe", "merge", probe, "-o", probe, "-y"}};
  for (const auto& arguments : onto_probe) EXPECT_THAT(run_catchlight(arguments).error, HasSubstr("is the input itself"));
  EXPECT_EQ(read_text(scene), before);
  EXPECT_EQ(read_text(probe), probe_before);
}

/// Progress is told as soon as a frame is tracked: none is where nothing else was said.
TEST_F(OverlayCommand, NamesThatAreWrongAreNoticedBeforeTheFootageIsTracked) {
  const std::string copy = copied_recording(2), none = "/nowhere/none";
  for (const char* option : {"--object.mesh", "--probe.image", "--glare.aperture", "--exposure.response", "--track", "--scene",
                             "--camera", "--shader-dir"}) {
    const CommandResult result = overlay(copy, out_, {option, none});
    EXPECT_THAT(result.error, AllOf(::testing::StartsWith("catchlight: error: "), HasSubstr(none))) << option;
  }
}

/// The last of many recordings is looked at before the first is replayed.
TEST_F(OverlayCommand, ReplayLooksAtAllRecordingsFirst) {
  const std::string copy = copied_recording(2), all = folder_.path("all");
  fs::copy(recording() + "/poses.csv", copy + "/poses.csv");
  fs::create_directories(all);
  fs::copy(copy, all + "/a", fs::copy_options::recursive);
  fs::rename(copy, all + "/b");
  const auto refused = [&](const std::string& named) {
    const CommandResult result = run_catchlight({"replay", all, "-o", folder_.path("sheets")});
    EXPECT_EQ(result.exit_code, 1);
    EXPECT_THAT(result.error, AllOf(::testing::StartsWith("catchlight: error: "), HasSubstr(named)));
  };
  fs::create_directories(all + "/b/truth");
  std::ofstream(all + "/b/truth/0001.png") << "a frame";
  refused("b/mask/0001.png: missing; every frame of truth/ needs its mask/");
  fs::remove_all(all + "/b/truth");
  std::ofstream(all + "/b/expected.toml") << "[mask\n";
  refused("b/expected.toml:1");
  fs::remove(all + "/b/expected.toml");
  fs::remove(all + "/b/object.glb");
  refused("b/object.glb");
  fs::remove(all + "/b/poses.csv");
  refused("b: nothing to compare with");
}

TEST_F(OverlayCommand, OptionsCanSayAllThatASceneFileSays) {
  const std::string copy = copied_recording(2), clip = copy + "/video.mp4", camera = copy + "/camera.yaml";
  const std::vector<std::string> tag{"--camera", camera, "--tag.id", "0", "--tag.size_m", "0.08"};
  std::vector<std::string> options = tag;
  for (const std::string& option :
       {std::string("--object.mesh"), copy + "/object.glb", std::string("--probe.image"), copy + "/probe.exr",
        std::string("--object.tag_from_object.rotation_deg"), std::string("90,0,12")})
    options.push_back(option);
  EXPECT_EQ(overlay(copy, out_).exit_code, 0);
  const CommandResult without = overlay(clip, folder_.path("options.mkv"), options);
  EXPECT_EQ(without.exit_code, 0) << without.error;
  EXPECT_TRUE(read_text(folder_.path("options.mkv")) == read_text(out_));
  const std::string without_any = overlay(clip, folder_.path("none.mkv"), tag).error;
  EXPECT_THAT(without_any, AllOf(HasSubstr("no light"), HasSubstr("--probe.image FILE"), HasSubstr("--object.mesh FILE")));
  std::vector<std::string> track{"track", clip, "-o", folder_.path("track.csv")};
  track.insert(track.end(), tag.begin(), tag.end());
  EXPECT_EQ(run_catchlight(track).exit_code, 0);
}

TEST_F(OverlayCommand, LayersNeverReplaceTheFootage) {
  const std::string copy = copied_recording(1), plates = folder_.path("plates");
  fs::create_directories(plates);
  run_shell("ffmpeg -v error -nostdin -i " + copy + "/video.mp4 " + plates + "/shot.%04d.exr");
  const std::string before = read_text(plates + "/shot.0001.exr");
  const CommandResult result = overlay(plates + "/shot.%04d.exr", plates + "/shot.%04d.exr",
                                       {"-y", "--scene", copy + "/scene.toml", "--camera", copy + "/camera.yaml"});
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_THAT(result.error, HasSubstr("is the input itself"));
  EXPECT_EQ(read_text(plates + "/shot.0001.exr"), before);
}

/// A recording that is not there is noticed when it is opened: whatever is said before it is said before the work.
TEST_F(OverlayCommand, OtherCommandsLookAtTheirOutputsFirstToo) {
  const std::string none = folder_.path("none"), taken = folder_.write("taken", "precious");
  const auto refused = [&](const std::vector<std::string>& arguments, const std::string& named) {
    const CommandResult result = run_catchlight(arguments);
    EXPECT_THAT(result.error, HasSubstr(named));
    EXPECT_NE(result.exit_code, 0);
  };
  refused({"track", none, "-o", "/proc/track.csv"}, "/proc/track.csv: cannot write into its folder");
  refused({"track", none, "-o", folder_.path("track.csv"), "--report", "/proc/report.json"}, "/proc/report.json: cannot write");
  refused({"reference", none, "--frame", "0", "-o", "/proc/traced.png"}, "/proc/traced.png: cannot write into its folder");
  refused({"reference", none, "--frame", "0", "-o", "/proc/traced.exr"}, "/proc/traced.exr: cannot write into its folder");
  refused({"calibrate", none, "--checkerboard", "9x6", "--square-m", "1", "-o", "/proc/camera.yaml"},
          "/proc/camera.yaml: cannot");
  refused({"glare", "--aperture", "circle", "-o", "/proc/glare.png"}, "/proc/glare.png: cannot write into its folder");

  // Replays are of recordings that are there: these would be refused for what their scene files say.
  const std::string recording = folder_.path("recording");
  folder_.write("recording/scene.toml", "nonsense");
  refused({"replay", recording, "-o", taken + "/sheets"}, taken + "/sheets: cannot be made");
  refused({"replay", recording, "-o", "/proc/sheets"}, "/proc/sheets: cannot be made");
  fs::create_directories(folder_.path("sheets/recording.png"));
  refused({"replay", recording, "-o", folder_.path("sheets")}, "recording.png: is a folder");
  fs::create_directories(recording + "/expected.toml");
  refused({"replay", recording, "-o", folder_.path("others"), "--bless"}, "expected.toml: is a folder");
}

}  // namespace
}  // namespace catchlight::tests
