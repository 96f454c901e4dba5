// overlay and track as users run them: what they write, and what they say about bad input.
#include <gmock/gmock.h>

#include <cstdlib>
#include <fstream>
#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>

#include "tests/app/commands/overlay_command.hpp"

namespace catchlight::tests {
namespace {

namespace fs = std::filesystem;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;

TEST_F(OverlayCommand, DrawsWithTheShadersOfAnotherFolder) {
  const std::string copy = copied_recording(1), shaders = folder_.path("shaders");
  fs::copy(CATCHLIGHT_SOURCE_DIR "/shaders", shaders);
  const auto drawn = [&](const std::string& output, std::vector<std::string> more) {
    const CommandResult result = overlay(copy, folder_.path(output), std::move(more));
    EXPECT_EQ(result.exit_code, 0) << result.error;
    return read_text(folder_.path(output));
  };
  const std::string built_in = drawn("built_in.mkv", {"--renderer", "gl"});
  EXPECT_EQ(drawn("same.mkv", {"--shader-dir", shaders}), built_in);
  replace_in(shaders + "/composite.frag", "vec4(new_code, changed", "vec4(vec3(0.25), changed");
  EXPECT_NE(drawn("edited.mkv", {"--shader-dir", shaders}), built_in);

  replace_in(shaders + "/composite.frag", "void main() {", "void main() {\n  nonsense;");
  const CommandResult broken = overlay(copy, out_, {"--shader-dir", shaders});
  expect_refused(broken, out_, {shaders + "/composite.frag:", "nonsense"});
}

TEST_F(OverlayCommand, RefusesAFolderWithoutAllShaders) {
  const std::string copy = copied_recording(1), shaders = folder_.path("shaders");
  expect_refused(overlay(copy, out_, {"--shader-dir", shaders}), out_, {"--shader-dir", shaders, "no folder"});
  fs::copy(CATCHLIGHT_SOURCE_DIR "/shaders", shaders);
  fs::remove(shaders + "/tone.frag");
  expect_refused(overlay(copy, out_, {"--shader-dir", shaders}), out_, {shaders + "/tone.frag: cannot be read", "--shader-dir"});
}

// --- what it does -----------------------------------------------------------------------------------------------------

TEST_F(OverlayCommand, TwoRunsGiveTheSameBytes) {
  const std::string copy = copied_recording(3);
  for (const char* name : {"a.mkv", "b.mkv"}) {
    const CommandResult result = overlay(copy, folder_.path(name));
    ASSERT_EQ(result.exit_code, 0) << result.error;
  }
  EXPECT_EQ(read_text(folder_.path("a.mkv")), read_text(folder_.path("b.mkv")));
}

TEST_F(OverlayCommand, ChunksAreTheSameBytesAsOneRun) {
  const std::string copy = copied_recording(6);
  ASSERT_EQ(overlay(copy, folder_.path("whole/%04d.png")).exit_code, 1) << "the folder must exist";
  for (const char* name : {"whole", "chunks", "tracked"}) fs::create_directories(folder_.path(name));
  ASSERT_EQ(overlay(copy, folder_.path("whole/%04d.png"), {"--track-out", folder_.path("track.csv")}).exit_code, 0);
  for (const char* range : {"0:3", "3:6"}) {
    ASSERT_EQ(overlay(copy, folder_.path("chunks/%04d.png"), {"--frames", range}).exit_code, 0);
    ASSERT_EQ(
        overlay(copy, folder_.path("tracked/%04d.png"), {"--frames", range, "--track", folder_.path("track.csv")}).exit_code, 0);
  }
  for (int frame = 0; frame < 6; ++frame) {
    const std::string name = "/000" + std::to_string(frame) + ".png", whole = read_text(folder_.path("whole") + name);
    EXPECT_FALSE(whole.empty());
    EXPECT_EQ(whole, read_text(folder_.path("chunks") + name)) << name;
    EXPECT_EQ(whole, read_text(folder_.path("tracked") + name)) << name;
  }
}

TEST_F(OverlayCommand, PixelsThatNothingVirtualReachesAreThePlates) {
  const std::string copy = copied_recording(1);
  ASSERT_EQ(overlay(copy, folder_.path("ours_%04d.png")).exit_code, 0);
  run_shell("ffmpeg -v error -nostdin -i " + copy + "/video.mp4 -sws_flags accurate_rnd+full_chroma_int " +
            folder_.path("plate.png"));
  const cv::Mat ours = cv::imread(folder_.path("ours_0000.png")), plate = cv::imread(folder_.path("plate.png"));
  ASSERT_EQ(ours.size(), plate.size());
  EXPECT_GT(cv::norm(ours, plate, cv::NORM_INF), 50) << "the object is there";
  EXPECT_EQ(cv::norm(ours.rowRange(0, 60), plate.rowRange(0, 60), cv::NORM_INF), 0) << "far from the tag";
}

TEST_F(OverlayCommand, ReportAndTrackSayWhatWasDone) {
  const std::string copy = copied_recording(2);
  const CommandResult result =
      overlay(copy, out_, {"--report", folder_.path("report.json"), "--track-out", folder_.path("track.csv")});
  ASSERT_EQ(result.exit_code, 0) << result.error;
  const std::string report = read_text(folder_.path("report.json"));
  for (const char* part : {"\"frames\": 2", "\"tracked_frames\": 2", "\"decode\"", "\"track\"", "\"object\"", "\"encode\"",
                           "median_ms", "renderer", "\"choice\": \"glare\"", "of 2 frames"})
    EXPECT_THAT(report, HasSubstr(part));
  EXPECT_THAT(read_text(folder_.path("track.csv")), HasSubstr("frame,time_s,found,r00"));
}

TEST_F(OverlayCommand, BarePosesServeAsATrack) {
  const std::string copy = copied_recording(2);
  const CommandResult result = overlay(copy, folder_.path("ours_%04d.png"), {"--track", recording() + "/poses.csv"});
  ASSERT_EQ(result.exit_code, 0) << result.error;
  ASSERT_EQ(overlay(copy, folder_.path("own_%04d.png")).exit_code, 0);
  const cv::Mat known = cv::imread(folder_.path("ours_0001.png")), tracked = cv::imread(folder_.path("own_0001.png"));
  cv::Mat difference;
  cv::absdiff(known, tracked, difference);
  EXPECT_LT(cv::mean(difference)[0], 0.3) << "our track is as good as the truth";
}

TEST_F(OverlayCommand, DebugDrawsOverTheFrameAndNotIntoLayers) {
  const std::string copy = copied_recording(1);
  ASSERT_EQ(overlay(copy, folder_.path("plain_%04d.png")).exit_code, 0);
  ASSERT_EQ(overlay(copy, folder_.path("debug_%04d.png"), {"--debug"}).exit_code, 0);
  const cv::Mat plain = cv::imread(folder_.path("plain_0000.png")), debug = cv::imread(folder_.path("debug_0000.png"));
  EXPECT_GT(cv::norm(plain.rowRange(0, 60), debug.rowRange(0, 60), cv::NORM_INF), 50) << "text";
  EXPECT_GT(cv::norm(plain.rowRange(200, 300), debug.rowRange(200, 300), cv::NORM_INF), 50) << "outline";
  EXPECT_EQ(cv::norm(plain.rowRange(400, 480), debug.rowRange(400, 480), cv::NORM_INF), 0) << "nothing";
  const std::string layers = folder_.path("layers.%04d.exr");
  expect_refused(overlay(copy, layers, {"--debug"}), layers, {"--debug", "layers.%04d.exr"}, 2);
}

TEST_F(OverlayCommand, FramesOfASequenceKeepTheirNumbers) {
  const std::string copy = copied_recording(2), plates = folder_.path("plates");
  fs::create_directories(plates);
  run_shell("ffmpeg -v error -nostdin -i " + copy + "/video.mp4 -start_number 1001 " + plates + "/shot.%04d.png");
  const CommandResult result =
      overlay(plates + "/shot.%04d.png", folder_.path("comp.%04d.png"),
              {"--scene", copy + "/scene.toml", "--camera", copy + "/camera.yaml", "--frames", "1002:1003"});
  ASSERT_EQ(result.exit_code, 0) << result.error;
  EXPECT_TRUE(fs::exists(folder_.path("comp.1002.png")));
  EXPECT_FALSE(fs::exists(folder_.path("comp.1001.png")));
}

TEST_F(OverlayCommand, Y4mOnStdoutIsOnlyVideo) {
  const CommandResult result = overlay(copied_recording(1), "-", {"--quiet"});
  ASSERT_EQ(result.exit_code, 0) << result.error;
  EXPECT_EQ(result.output.substr(0, 10), "YUV4MPEG2 ");
  EXPECT_EQ(result.error, "");
}

// --- footage ----------------------------------------------------------------------------------------------------------

TEST_F(OverlayCommand, NoSuchFile) {
  expect_refused(overlay(folder_.path("nothing"), out_), out_, {"nothing"});
}

TEST_F(OverlayCommand, NotAVideo) {
  const std::string copy = copied_recording(1);
  std::ofstream(copy + "/video.mp4") << "these are no pictures\n";
  expect_refused(overlay(copy, out_), out_, {"video.mp4"});
}

TEST_F(OverlayCommand, TruncatedVideoKeepsTheFramesBeforeTheDamage) {
  const std::string copy = copied_recording(12);
  run_shell("ffmpeg -v error -nostdin -y -i " + copy + "/video.mp4 -c copy " + copy + "/video.mkv && rm " + copy + "/video.mp4");
  fs::resize_file(copy + "/video.mkv", fs::file_size(copy + "/video.mkv") / 2);
  const CommandResult result = overlay(copy, out_, {"--report", folder_.path("report.json")});
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_THAT(result.error, HasSubstr("video.mkv"));
  EXPECT_TRUE(fs::exists(out_));
  EXPECT_THAT(read_text(folder_.path("report.json")), Not(HasSubstr("\"frames\": 12")));
}

TEST_F(OverlayCommand, TagThatNeverAppearsIsRefusedBeforeAnythingIsWritten) {
  expect_refused(overlay(copied_recording(3), out_, {"--tag.id", "17"}), out_, {"never found in 3 frames", "give --tag.id 0"});
}

TEST_F(OverlayCommand, TagThatNeverAppearsPassesTheFootageThroughWhereThatIsAllowed) {
  const std::string copy = copied_recording(3);
  const CommandResult result = overlay(copy, folder_.path("ours_%04d.png"), {"--tag.id", "17", "--allow-lost"});
  EXPECT_EQ(result.exit_code, 0);
  EXPECT_EQ(count_of("catchlight: warning: the tag was never found in 3 frames", result.error), 1);
  run_shell("ffmpeg -v error -nostdin -i " + copy + "/video.mp4 -sws_flags accurate_rnd+full_chroma_int -start_number 0 " +
            folder_.path("plate_%04d.png"));
  for (const char* number : {"0000", "0001", "0002"}) {
    const cv::Mat ours = cv::imread(folder_.path("ours_" + std::string(number) + ".png")),
                  plate = cv::imread(folder_.path("plate_" + std::string(number) + ".png"));
    EXPECT_EQ(cv::norm(ours, plate, cv::NORM_INF), 0);
  }
}

TEST_F(OverlayCommand, LostFramesOfAGivenTrackAreWarnedOfOnce) {
  const std::string copy = copied_recording(3), track = folder_.path("track.csv");
  ASSERT_EQ(run_catchlight({"track", copy, "-o", track, "--frames", "0:1", "--quiet"}).exit_code, 0);
  EXPECT_EQ(count_of("catchlight: warning: no tag in 2 of 3 frames", overlay(copy, out_, {"--track", track}).error), 1);
}

TEST_F(OverlayCommand, OutputOverItsOwnInputIsRefused) {
  const std::string copy = copied_recording(1), video = copy + "/video.mp4", before = read_text(video);
  const CommandResult result = overlay(copy, video, {"-y"});
  EXPECT_NE(result.exit_code, 0);
  EXPECT_THAT(result.error, HasSubstr("video.mp4"));
  EXPECT_EQ(read_text(video), before);
}

TEST_F(OverlayCommand, UnwritableOutputIsFoundOutBeforeTheWork) {
  const std::string nowhere = folder_.path("no/such/folder/out.mp4");
  expect_refused(overlay(copied_recording(1), nowhere), nowhere, {"no/such/folder"});
}

TEST_F(OverlayCommand, UnknownExtensionNamesThoseThereAre) {
  const std::string odd = folder_.path("out.wmv9");
  const CommandResult result = overlay(copied_recording(1), odd);
  EXPECT_NE(result.exit_code, 0);
  EXPECT_THAT(result.error, HasSubstr(".mp4"));
}

TEST_F(OverlayCommand, EmptyRangesAreUsageErrors) {
  const std::string copy = copied_recording(2);
  for (const char* range : {"5:5", "7:3", "x:3", "1:2:3"})
    expect_refused(overlay(copy, out_, {"--frames", range}), out_, {range}, 2);
  expect_refused(overlay(copy, out_, {"--frames", "100:200"}), out_, {"--frames"});
}

// --- camera, scene, probe, mesh ---------------------------------------------------------------------------------------

TEST_F(OverlayCommand, WrongFamilyNamesThoseThereAre) {
  expect_refused(overlay(copied_recording(1), out_, {"--tag.family", "tag99h9"}), out_, {"tag99h9", "tag36h11"}, 2);
}

TEST_F(OverlayCommand, CameraFileOfAnotherSizeNamesBoth) {
  const std::string copy = copied_recording(1);
  replace_in(copy + "/camera.yaml", "image_width: 640", "image_width: 1280");
  expect_refused(overlay(copy, out_), out_, {"camera.yaml", "1280", "640"});
}

TEST_F(OverlayCommand, UnknownKeyNamesFileLineColumnAndTheNearestKey) {
  const std::string copy = copied_recording(1);
  replace_in(copy + "/scene.toml", "[exposure]\nmode", "[glare]\nenabld = false\n[exposure]\nmode");
  expect_refused(overlay(copy, out_), out_, {"scene.toml:", ":1: ", "enabld", "glare.enabled"});
}

TEST_F(OverlayCommand, ProbeWithNanOrNegativeTexelsIsNamedAndCounted) {
  const std::string copy = copied_recording(1);
  std::vector<float> planes(3 * 64 * 32, 0.5f);
  planes[70] = std::nanf("");
  planes[71] = -1.0f;
  std::ofstream(folder_.path("raw"), std::ios::binary)
      .write(reinterpret_cast<const char*>(planes.data()), static_cast<std::streamsize>(planes.size() * 4));
  run_shell("ffmpeg -v error -nostdin -f rawvideo -pix_fmt gbrpf32le -s 64x32 -i " + folder_.path("raw") + " " + copy +
            "/bad.exr");
  const CommandResult lenient = overlay(copy, out_, {"--probe.image", copy + "/bad.exr"});
  EXPECT_EQ(lenient.exit_code, 0) << lenient.error;
  EXPECT_THAT(lenient.error, HasSubstr("bad.exr"));
  EXPECT_THAT(lenient.error, HasSubstr("2 texels"));
  fs::remove(out_);
  expect_refused(overlay(copy, out_, {"--probe.image", copy + "/bad.exr", "--strict"}), out_, {"bad.exr"});
}

TEST_F(OverlayCommand, MeshWithoutTrianglesIsRefused) {
  const std::string copy = copied_recording(1);
  std::ofstream(copy + "/empty.obj") << "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
  expect_refused(overlay(copy, out_, {"--object.mesh", copy + "/empty.obj"}), out_, {"empty.obj", "triangle"});
}

TEST_F(OverlayCommand, ObjectsAreNamedByTheirNumbers) {
  const std::string copy = copied_recording(1);
  std::ofstream(copy + "/scene.toml", std::ios::app) << "\n[[object]]\nmesh = \"object.glb\"\n";
  for (const std::string& option : {std::string("--object[1].mesh=/nowhere.obj"), std::string("--object[0].mesh=/nowhere.obj")})
    expect_refused(overlay(copy, out_, {option}), out_, {"/nowhere.obj"});
  expect_refused(overlay(copy, out_, {"--object[1].tag_from_object.scale", "0"}), out_,
                 {"--object[1].tag_from_object.scale is 0; expected"}, 2);
  expect_refused(overlay(copy, out_, {"--object.mesh", "/nowhere.obj"}), out_,
                 {"the scene has 2 objects", "--object[0].mesh to --object[1].mesh"}, 2);
  expect_refused(overlay(copy, out_, {"--object[2].mesh", "/nowhere.obj"}), out_, {"the scene has 2 objects"}, 2);
  expect_refused(overlay(copy, out_, {"--object[1].mash", "/nowhere.obj"}), out_,
                 {"unknown option --object[1].mash; did you mean --object.mesh"}, 2);
}

TEST_F(OverlayCommand, TestObjectsNeedNoFileAndSizesAreSaid) {
  const std::string copy = copied_recording(1);
  fs::remove(copy + "/object.glb");
  const CommandResult balls = overlay(copy, out_, {"--object.mesh", "chrome-and-grey"});
  EXPECT_EQ(balls.exit_code, 0) << balls.error;
  EXPECT_THAT(balls.error, HasSubstr(" × 48 mm on a tag of 80 mm, 0."));
  const CommandResult huge = overlay(copy, out_, {"-y", "--object.mesh", "sphere", "--object.tag_from_object.scale", "1000"});
  EXPECT_THAT(huge.error, HasSubstr("the camera is inside the object"));
}

TEST_F(OverlayCommand, MeshWithoutNormalsIsDrawn) {
  const std::string copy = copied_recording(1);
  std::ofstream(copy + "/bare.obj")
      << "v -0.03 0 -0.03\nv 0.03 0 -0.03\nv 0 0 0.03\nv 0 0.06 0\nf 1 2 3\nf 1 4 2\nf 2 4 3\nf 3 4 1\n";
  const CommandResult result = overlay(copy, out_, {"--object.mesh", copy + "/bare.obj"});
  EXPECT_EQ(result.exit_code, 0) << result.error;
}

// --- track ------------------------------------------------------------------------------------------------------------

TEST_F(OverlayCommand, TrackNeedsNeitherMeshNorProbe) {
  const std::string copy = copied_recording(2);
  fs::remove(copy + "/probe.exr");
  fs::remove(copy + "/object.glb");
  const CommandResult result = run_catchlight({"track", copy, "-o", folder_.path("track.csv"), "--quiet"});
  ASSERT_EQ(result.exit_code, 0) << result.error;
  EXPECT_THAT(read_text(folder_.path("track.csv")), HasSubstr("tracking"));
}

TEST_F(OverlayCommand, KnownPosesAreWrittenInAnotherFormatWithTheFootagesTimes) {
  const std::string copy = copied_recording(2);
  const std::vector<std::string> arguments = {"track", copy, "--track", recording() + "/poses.csv", "--quiet"};
  const auto exported = [&](const std::string& name) {
    std::vector<std::string> all = arguments;
    all.insert(all.end(), {"-o", folder_.path(name)});
    const CommandResult result = run_catchlight(all);
    EXPECT_EQ(result.exit_code, 0) << result.error;
    return read_text(folder_.path(name));
  };
  EXPECT_THAT(exported("path.tum"), HasSubstr("\n0 -0.28"));
  EXPECT_THAT(exported("path.tum.csv"), HasSubstr("\n1,0.0416"));
  EXPECT_THAT(exported("path.chan"), HasSubstr("1 -0.28"));
  EXPECT_EQ(exported("path.glb").substr(0, 4), "glTF");
}

TEST_F(OverlayCommand, UnknownTrackFormatIsFoundOutBeforeTheWork) {
  const std::string copy = copied_recording(1), odd = folder_.path("track.fbx");
  expect_refused(run_catchlight({"track", copy, "-o", odd}), odd, {"track.fbx", "\".glb\""}, 2);
  expect_refused(overlay(copy, out_, {"--track-out", odd}), out_, {"track.fbx", "\".glb\""}, 2);
}

}  // namespace
}  // namespace catchlight::tests
