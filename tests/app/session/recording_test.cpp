#include "app/session/recording.hpp"
#include "catchlight/camera.hpp"
#include "catchlight/error.hpp"
#include "tests/support/temporary_folder.hpp"

#include <gmock/gmock.h>

#include <cmath>

namespace catchlight::app {
namespace {

using ::testing::HasSubstr;
using tests::message_of;
using tests::TemporaryFolder;

constexpr const char* kCamera =
    "%YAML:1.0\n---\nimage_width: 640\nimage_height: 480\n"
    "camera_matrix: !!opencv-matrix\n   rows: 3\n   cols: 3\n   dt: d\n   data: [ 600., 0., 319.5, 0., 600., 239.5, 0., 0., 1. "
    "]\n"
    "distortion_coefficients: !!opencv-matrix\n   rows: 1\n   cols: 5\n   dt: d\n   data: [ 0., 0., 0., 0., 0. ]\n";

/// A folder with all that a recording needs; the footage is never opened here.
struct RecordingFolder : TemporaryFolder {
  RecordingFolder() {
    write("video.mp4", "");
    write("camera.yaml", kCamera);
    write("scene.toml", "[tag]\nid = 5\nsize_m = 0.1\n");
  }
};

RecordingOverrides with(std::vector<std::pair<std::string, std::string>> values) {
  RecordingOverrides overrides;
  overrides.parameters = std::move(values);
  return overrides;
}

TEST(RecordingFolder, HasFootageCameraAndScene) {
  const RecordingFolder folder;
  const Recording recording = open_recording(folder.path());
  EXPECT_EQ(recording.footage, folder.path("video.mp4"));
  EXPECT_EQ(recording.camera_file, folder.path("camera.yaml"));
  EXPECT_EQ(recording.scene.tag.id, 5);
  EXPECT_EQ(recording.name, std::filesystem::path(folder.path()).filename());
  EXPECT_FALSE(recording.poses_csv || recording.truth_folder || recording.mask_folder || recording.expected_toml);
}

TEST(RecordingFolder, NameDoesNotDependOnHowTheFolderIsWritten) {
  const RecordingFolder folder;
  EXPECT_EQ(open_recording(folder.path() + "/").name, open_recording(folder.path()).name);
  EXPECT_EQ(open_recording(folder.path() + "/.").name, open_recording(folder.path()).name);
}

TEST(RecordingFolder, TruthIsFoundWhereItIs) {
  const RecordingFolder folder;
  folder.write("poses.csv", "");
  folder.write("truth/0000.png", "");
  folder.write("mask/0000.png", "");
  folder.write("expected.toml", "");
  const Recording recording = open_recording(folder.path());
  EXPECT_EQ(recording.poses_csv, folder.path("poses.csv"));
  EXPECT_EQ(recording.truth_folder, folder.path("truth"));
  EXPECT_EQ(recording.mask_folder, folder.path("mask"));
  EXPECT_EQ(recording.expected_toml, folder.path("expected.toml"));
}

TEST(RecordingFolder, EveryContainerIsFound) {
  for (const char* name : {"video.mp4", "video.mkv", "video.mov", "video.avi"}) {
    const RecordingFolder folder;
    std::filesystem::remove(folder.path("video.mp4"));
    folder.write(name, "");
    EXPECT_EQ(open_recording(folder.path()).footage, folder.path(name));
  }
}

TEST(RecordingFolder, EveryKindOfStillIsFound) {
  for (const std::string extension : {".png", ".jpg", ".exr"}) {
    const RecordingFolder folder;
    std::filesystem::remove(folder.path("video.mp4"));
    folder.write("plate/thumbnail.png", "");
    folder.write("plate/0003" + extension, "");
    EXPECT_EQ(open_recording(folder.path()).footage, folder.path("plate/%04d" + extension));
  }
}

TEST(RecordingFolder, WithoutFootageSaysWhatIsExpected) {
  const RecordingFolder folder;
  std::filesystem::remove(folder.path("video.mp4"));
  folder.write("plate/notes.txt", "");
  EXPECT_EQ(message_of<Error>([&] { open_recording(folder.path()); }),
            folder.path() +
                ": no footage in this folder; expected video.mp4 (or .mkv, .mov, .avi) or plate/0000.png, ... (or .jpg, .exr)");
}

TEST(RecordingFolder, WithoutCameraSaysWhatSuppliesIt) {
  const RecordingFolder folder;
  std::filesystem::remove(folder.path("camera.yaml"));
  EXPECT_EQ(message_of<Error>([&] { open_recording(folder.path()); }),
            folder.path("video.mp4") + ": no camera (expected " + folder.path("camera.yaml") +
                "); pass --camera FILE, or --fov DEGREES where it is not calibrated");
}

TEST(RecordingFolder, FootageThatIsNotTakenIsNamed) {
  const RecordingFolder folder;
  EXPECT_TRUE(open_recording(folder.path()).warnings.empty());
  for (const char* second : {"plate/0000.exr", "plate/0001.png", "video.mov"}) {
    folder.write(second, "");
    const Recording recording = open_recording(folder.path());
    EXPECT_EQ(recording.footage, folder.path("video.mp4"));
    ASSERT_EQ(recording.warnings.size(), 1u);
    const std::string other = std::string(second).starts_with("plate") ? "plate/%04d" : second;
    EXPECT_THAT(recording.warnings[0], HasSubstr("the footage is " + folder.path("video.mp4") + ", not " + folder.path(other)));
  }
}

TEST(RecordingFolder, AFieldOfViewThatGoesBeforeACameraFileIsToldOf) {
  const RecordingFolder folder;
  RecordingOverrides overrides;
  overrides.fov_deg = 60;
  const Recording recording = open_recording(folder.path(), overrides);
  ASSERT_EQ(recording.warnings.size(), 1u);
  EXPECT_THAT(recording.warnings[0], HasSubstr("--fov overrides " + folder.path("camera.yaml")));
  std::filesystem::remove(folder.path("camera.yaml"));
  EXPECT_TRUE(open_recording(folder.path(), overrides).warnings.empty());
}

TEST(RecordingFolder, WithoutSceneSaysWhatSuppliesIt) {
  const RecordingFolder folder;
  std::filesystem::remove(folder.path("scene.toml"));
  EXPECT_EQ(message_of<Error>([&] { open_recording(folder.path()); }),
            folder.path("video.mp4") + ": no scene (expected " + folder.path("scene.toml") +
                "); pass --scene FILE, or say it by options, --tag.id NUMBER and --tag.size_m METRES at least");
}

TEST(BareFootage, TakesSceneAndCameraFromTheOverrides) {
  const RecordingFolder folder;
  const std::string clip = folder.write("clip.mkv", "");
  RecordingOverrides overrides;
  overrides.scene_file = folder.path("scene.toml");
  overrides.camera_file = folder.path("camera.yaml");
  const Recording recording = open_recording(clip, overrides);
  EXPECT_EQ(recording.name, "clip");
  EXPECT_EQ(recording.folder, "");
  EXPECT_EQ(recording.footage, clip);
  EXPECT_EQ(recording.scene.tag.id, 5);
}

TEST(BareFootage, NeedsNoSceneFileWhereOptionsDescribeTheTag) {
  const RecordingFolder folder;
  RecordingOverrides overrides = with({{"tag.id", "12"}, {"tag.size_m", "0.14"}, {"probe.image", "room.exr"}});
  overrides.fov_deg = 60;
  const Recording recording = open_recording(folder.path("video.mp4"), overrides);
  EXPECT_EQ(recording.scene_file, std::nullopt);
  EXPECT_EQ(recording.scene.tag.id, 12);
  EXPECT_EQ(recording.scene.tag.size_m, 0.14);
  EXPECT_EQ(recording.scene.tag.family, "tag36h11");
  EXPECT_EQ(recording.scene.resolve(recording.scene.probe.image), std::filesystem::absolute("room.exr"));
}

/// A size that nobody gave would make everything as many times too large as the print is not 8 cm wide.
TEST(BareFootage, WithoutSceneFileTheTagIsNotGuessed) {
  const RecordingFolder folder;
  for (const char* key : {"tag.id", "tag.size_m"}) {
    RecordingOverrides overrides = with({{key, "1"}});
    overrides.fov_deg = 60;
    EXPECT_THAT(message_of<Error>([&] { open_recording(folder.path("video.mp4"), overrides); }),
                HasSubstr("--tag.id NUMBER and --tag.size_m METRES at least"));
  }
}

TEST(BareFootage, PatternsCamerasAndStreamsAreNotLookedUpAsFiles) {
  const RecordingFolder folder;
  RecordingOverrides overrides;
  overrides.scene_file = folder.path("scene.toml");
  overrides.fov_deg = 60;
  EXPECT_EQ(open_recording("rtsp://camera.example/live", overrides).name, "live");
  EXPECT_EQ(open_recording("/nowhere/plate/%04d.png", overrides).name, "plate");
}

TEST(BareFootage, ACameraIsNamedByItsNumber) {
  EXPECT_TRUE(is_one_pass("camera:0"));
  EXPECT_THAT(message_of<Error>([] { MediaSource::open("camera:99"); }), HasSubstr("camera:99"));
  EXPECT_THAT(message_of<Error>([] { MediaSource::open("camera:front"); }), HasSubstr("as in camera:0 for /dev/video0"));
}

TEST(BareFootage, MissingFileSaysWhatCanBeGiven) {
  EXPECT_THAT(message_of<Error>([] { open_recording("/nowhere/clip.mp4"); }),
              HasSubstr("/nowhere/clip.mp4: no such file or folder; expected"));
}

TEST(BareFootage, WithoutCameraOrSceneSaysWhatSuppliesThem) {
  const RecordingFolder folder;
  RecordingOverrides overrides;
  EXPECT_THAT(message_of<Error>([&] { open_recording(folder.path("video.mp4"), overrides); }),
              HasSubstr("pass --camera FILE, or --fov"));
  overrides.fov_deg = 60;
  EXPECT_THAT(message_of<Error>([&] { open_recording(folder.path("video.mp4"), overrides); }), HasSubstr("pass --scene FILE"));
}

TEST(RecordingOverrides, GoBeforeTheSceneFileWhichGoesBeforeTheDefaults) {
  const RecordingFolder folder;
  const Recording recording = open_recording(folder.path(), with({{"tag.id", "7"}}));
  EXPECT_EQ(recording.scene.tag.id, 7);               // option
  EXPECT_EQ(recording.scene.tag.size_m, 0.1);         // scene file
  EXPECT_EQ(recording.scene.tag.family, "tag36h11");  // default
}

TEST(RecordingFolder, ABoardWhoseTagsCannotBeToldApartIsRefused) {
  const RecordingFolder folder;
  const auto refusal = [&](const std::string& board) {
    folder.write("scene.toml", "[tag]\nid = 5\nsize_m = 0.1\n" + board);
    return message_of<Error>([&] { open_recording(folder.path()); });
  };
  const std::string place = "tag_from_this = { translation_m = [0.2, 0, 0] }\n";
  EXPECT_THAT(refusal("[[tag.bundle]]\nid = 5\n" + place), HasSubstr("tag36h11 #5 twice"));
  EXPECT_THAT(refusal("[[tag.bundle]]\nid = 6\n"), HasSubstr("where the tag itself does; give its place"));
  folder.write("scene.toml", "[tag]\nid = 5\nsize_m = 0.1\n[[tag.bundle]]\nid = 6\n" + place);
  EXPECT_EQ(open_recording(folder.path()).scene.tag.bundle.size(), 1u);
}

TEST(RecordingOverrides, LastOptionWins) {
  const RecordingFolder folder;
  EXPECT_EQ(open_recording(folder.path(), with({{"tag.id", "7"}, {"tag.id", "8"}})).scene.tag.id, 8);
}

TEST(RecordingOverrides, OutOfRangeIsAUsageError) {
  const RecordingFolder folder;
  EXPECT_THROW(open_recording(folder.path(), with({{"tag.id", "-1"}})), UsageError);
}

TEST(RecordingOverrides, CameraAndFieldOfViewExcludeEachOther) {
  const RecordingFolder folder;
  RecordingOverrides overrides;
  overrides.camera_file = folder.path("camera.yaml");
  overrides.fov_deg = 60;
  EXPECT_THAT(message_of<UsageError>([&] { open_recording(folder.path(), overrides); }), HasSubstr("--camera and --fov"));
}

TEST(RecordingOverrides, ImpossibleFieldsOfViewAreRefused) {
  const RecordingFolder folder;
  for (const double fov_deg : {0.0, -60.0, 180.0, std::nan("")}) {
    RecordingOverrides overrides;
    overrides.fov_deg = fov_deg;
    EXPECT_THROW(open_recording(folder.path(), overrides), UsageError) << fov_deg;
  }
}

TEST(CameraForFootage, IsTheFilesWhereTheSizesAgree) {
  const RecordingFolder folder;
  const CameraModel camera = camera_for_footage(open_recording(folder.path()), 640, 480);
  EXPECT_EQ(camera.fx_px, 600);
  EXPECT_EQ(camera.cx_px, 319.5);
}

TEST(CameraForFootage, OtherSizeNamesBothAndTheFile) {
  const RecordingFolder folder;
  const Recording recording = open_recording(folder.path());
  const std::string message = message_of<Error>([&] { camera_for_footage(recording, 1280, 720); });
  EXPECT_THAT(message, HasSubstr(folder.path("camera.yaml") + ": is for pictures of 640x480"));
  EXPECT_THAT(message, HasSubstr("is 1280x720"));
}

TEST(CameraForFootage, ACameraThatPythonWroteIsFoundInTheFolder) {
  const RecordingFolder folder;
  std::filesystem::remove(folder.path("camera.yaml"));
  folder.write("camera.json", R"({"image_width": 640, "image_height": 480, "dist_coeffs": [0, 0, 0, 0],
    "camera_matrix": [[500, 0, 319.5], [0, 500, 239.5], [0, 0, 1]]})");
  EXPECT_EQ(camera_for_footage(open_recording(folder.path()), 640, 480).fx_px, 500);
}

/// tan(45 deg) = 1: at 90 degrees the focal length is half the width.
TEST(CameraForFootage, FieldOfViewGoesBeforeTheFoldersCamera) {
  const RecordingFolder folder;
  RecordingOverrides overrides;
  overrides.fov_deg = 90;
  const CameraModel camera = camera_for_footage(open_recording(folder.path(), overrides), 800, 600);
  EXPECT_NEAR(camera.fx_px, 400, 1e-9);
  EXPECT_EQ(camera.width_px, 800);
}

}  // namespace
}  // namespace catchlight::app
