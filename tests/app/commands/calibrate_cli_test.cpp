// calibrate as users run it, on footage of boards rendered through a known camera and on real footage.
#include <gmock/gmock.h>

#include <cstdio>
#include <cstdlib>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <regex>
#include <set>

#include "catchlight/camera.hpp"
#include "catchlight/rigid_transform.hpp"
#include "tests/support/board_picture.hpp"
#include "tests/support/run_command.hpp"
#include "tests/support/synthetic_tag.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tracking/camera/camera_file.hpp"

namespace catchlight::tests {
namespace {

namespace fs = std::filesystem;
using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::Not;
using tracking::tag_pose;

constexpr int kFailure = 1, kUsage = 2;

CameraModel barrel_camera() {
  return {640, 480, 520, 524, 331.2, 236.7, {-0.3, 0.12, 0.0015, -0.001}};
}

/// A pose of the board: where its middle is seen, how far it is, and its turns about the camera's axes.
struct Placement {
  glm::dvec2 middle_px;
  double distance_m;
  glm::dvec3 turn_deg;
};

std::vector<Placement> good_places() {
  return {{{320, 240}, 0.36, {30, 0, 0}},    {{320, 240}, 0.36, {-30, 5, 20}}, {{320, 240}, 0.32, {0, 35, 0}},
          {{230, 170}, 0.4, {20, 25, 0}},    {{420, 170}, 0.4, {20, -25, 10}}, {{230, 310}, 0.4, {-20, 25, 40}},
          {{420, 310}, 0.4, {-20, -25, 0}},  {{320, 240}, 0.45, {40, 20, 0}},  {{460, 240}, 0.45, {10, 40, 0}},
          {{180, 240}, 0.45, {-35, -15, 60}}};
}

cv::Mat1b frame_of(const BoardLight& board, const Placement& place, unsigned seed = 1) {
  const RigidTransform camera_from_board = tag_pose(barrel_camera(), place.middle_px, place.distance_m, place.turn_deg);
  return board_picture(barrel_camera(), camera_from_board, board, seed);
}

cv::Mat1b checkerboard_frame(const Placement& place) {
  return frame_of(checkerboard(9, 6, 0.025), place);
}

/// Four by three tags, 40 mm each, 50 mm apart.
cv::Mat1b tag_board_frame(const Placement& place, int first_id = 5) {
  return frame_of(tag_board(4, 3, 0.04, 0.05, first_id), place);
}

/// A folder of numbered pictures.
class Footage : public TemporaryFolder {
 public:
  void add(const cv::Mat& picture) {
    char name[16];
    std::snprintf(name, sizeof name, "%04d.png", count_++);
    cv::imwrite(path(name), picture);
  }
  std::string pattern() const { return path("%04d.png"); }

 private:
  int count_ = 0;
};

CommandResult calibrate(const std::string& footage, const std::string& output, std::vector<std::string> more) {
  std::vector<std::string> arguments{"calibrate", footage, "-o", output};
  arguments.insert(arguments.end(), more.begin(), more.end());
  return run_catchlight(arguments);
}

const std::vector<std::string> kCheckerboard{"--checkerboard", "9x6", "--square-m", "0.025"};
const std::vector<std::string> kTagBoard{"--tags", "4x3", "--size-m", "0.04", "--spacing-m", "0.05", "--first-id", "5"};

/// "NAME value +- deviation" as printed.
void expect_within_stated(const std::string& text, const std::string& name, double truth, double most_deviation) {
  std::smatch match;
  ASSERT_TRUE(std::regex_search(text, match, std::regex(name + " (-?[0-9.]+) \\+- ([0-9.]+)"))) << name << " in\n" << text;
  const double value = std::stod(match[1]), deviation = std::stod(match[2]);
  EXPECT_NEAR(value, truth, 4 * deviation) << name;
  EXPECT_LT(deviation, most_deviation) << name;
}

void expect_barrel_camera(const CommandResult& result, const std::string& file) {
  ASSERT_EQ(result.exit_code, 0) << result.error;
  expect_within_stated(result.output, "fx", 520, 0.5);
  expect_within_stated(result.output, "fy", 524, 0.5);
  expect_within_stated(result.output, "cx", 331.2, 0.5);
  expect_within_stated(result.output, "cy", 236.7, 0.5);
  expect_within_stated(result.output, "k1", -0.3, 0.01);
  expect_within_stated(result.output, "k2", 0.12, 0.05);
  const CameraModel read = tracking::read_camera_file(file);
  EXPECT_EQ(read.width_px, 640);
  EXPECT_NEAR(read.fx_px, 520, 1);
}

TEST(Calibrate, CheckerboardGivesTheCameraThatFilmedIt) {
  Footage footage;
  for (const Placement& place : good_places()) footage.add(checkerboard_frame(place));
  const TemporaryFolder out;
  const CommandResult result = calibrate(footage.pattern(), out.path("camera.yaml"), kCheckerboard);
  expect_barrel_camera(result, out.path("camera.yaml"));
  EXPECT_THAT(result.error, HasSubstr("board seen in 10 of 10 frames tried, of 10"));
}

TEST(Calibrate, TagBoardGivesTheCameraThatFilmedIt) {
  Footage footage;
  for (const Placement& place : good_places()) footage.add(tag_board_frame(place));
  const TemporaryFolder out;
  std::vector<std::string> options = kTagBoard;
  options.insert(options.end(), {"--picture", out.path("picture.png")});
  const CommandResult result = calibrate(footage.pattern(), out.path("camera.yaml"), options);
  expect_barrel_camera(result, out.path("camera.yaml"));
  std::smatch rms;
  ASSERT_TRUE(std::regex_search(result.output, rms, std::regex("error +([0-9.]+) px RMS over 10 frames")));
  EXPECT_LT(std::stod(rms[1]), 0.1);
  const cv::Mat picture = cv::imread(out.path("picture.png"));
  EXPECT_EQ(picture.cols, 1280);
  EXPECT_THAT(out.names(), ElementsAre("camera.yaml", "picture.png"));
}

TEST(Calibrate, ABoardThatTagHasPrintedIsTheBoardThatIsMeasured) {
  const TemporaryFolder out;
  const CommandResult print = run_catchlight({"tag", "-o", out.path("board.png"), "--board", "4x3", "--ids", "5:17", "--size-m",
                                              "0.04", "--spacing-m", "0.05", "--paper", "fit", "--dpi", "508"});
  ASSERT_EQ(print.exit_code, 0) << print.error;
  const BoardLight sheet = printed(cv::imread(out.path("board.png"), cv::IMREAD_GRAYSCALE), 20000);  // 508 dpi
  Footage footage;
  for (const Placement& place : good_places()) footage.add(frame_of(sheet, place));
  const CommandResult result = calibrate(footage.pattern(), out.path("camera.yaml"), kTagBoard);
  expect_barrel_camera(result, out.path("camera.yaml"));
  EXPECT_THAT(result.output, HasSubstr("0      48 "));
}

TEST(Calibrate, BlurredFramesAreLeftOutAndNamed) {
  Footage footage;
  for (std::size_t i = 0; i < good_places().size(); ++i) {
    cv::Mat1b frame = checkerboard_frame(good_places()[i]);
    if (i == 2 || i == 7) cv::GaussianBlur(frame, frame, {}, 2.5);
    footage.add(frame);
  }
  const TemporaryFolder out;
  const CommandResult result = calibrate(footage.pattern(), out.path("camera.yaml"), kCheckerboard);
  EXPECT_EQ(result.exit_code, 0) << result.error;
  EXPECT_THAT(result.error, HasSubstr("left out as blurred: frame 2, 7\n"));
  EXPECT_THAT(result.output, HasSubstr("over 8 frames"));
}

TEST(Calibrate, OfManyFramesFortyAreKeptAndEveryLookAmongThem) {
  // Each view four times over: 48 frames hold twelve looks.
  Footage footage;
  std::vector<Placement> places = good_places();
  places.push_back({{320, 240}, 0.4, {0, -35, 90}});
  places.push_back({{300, 200}, 0.4, {25, 20, 45}});
  std::vector<cv::Mat1b> looks;
  for (const Placement& place : places) looks.push_back(tag_board_frame(place));
  for (int round = 0; round < 4; ++round)
    for (const cv::Mat1b& look : looks) footage.add(look);
  const TemporaryFolder out;
  const CommandResult result = calibrate(footage.pattern(), out.path("camera.yaml"), kTagBoard);
  ASSERT_EQ(result.exit_code, 0) << result.error;
  EXPECT_THAT(result.output, HasSubstr("over 40 frames"));
  std::set<int> kept;
  const std::regex line("\n +([0-9]+) +48 ");
  for (std::sregex_iterator match(result.output.begin(), result.output.end(), line), end; match != end; ++match)
    kept.insert(std::stoi((*match)[1]) % 12);
  EXPECT_EQ(kept.size(), 12u);
}

TEST(Calibrate, FootageThatBreaksOffIsUsedAsFarAsItGoes) {
  Footage footage;
  for (const Placement& place : good_places()) footage.add(tag_board_frame(place));
  const TemporaryFolder out;
  ASSERT_EQ(
      std::system(("ffmpeg -v error -nostdin -i " + footage.pattern() + " -c:v ffv1 -g 1 " + out.path("whole.avi")).c_str()), 0);
  const std::string whole = read_text(out.path("whole.avi"));
  const std::string cut = out.write("cut.avi", whole.substr(0, whole.size() * 3 / 4));
  const CommandResult result = calibrate(cut, out.path("camera.yaml"), kTagBoard);
  EXPECT_EQ(result.exit_code, 0) << result.error;
  EXPECT_THAT(result.error, AllOf(HasSubstr("catchlight: warning: "), HasSubstr("calibrating with what was read before")));
  EXPECT_THAT(result.output, ::testing::ContainsRegex("over [67] frames"));
}

TEST(Calibrate, OnlyTheFramesAskedForAreLookedAt) {
  Footage footage;
  for (const Placement& place : good_places()) footage.add(tag_board_frame(place));
  const TemporaryFolder out;
  std::vector<std::string> options = kTagBoard;
  options.insert(options.end(), {"--frames", "3:8"});
  const CommandResult result = calibrate(footage.pattern(), out.path("camera.yaml"), options);
  EXPECT_EQ(result.exit_code, 0) << result.error;
  EXPECT_THAT(result.error, HasSubstr("board seen in 5 of 5 frames tried, of 5"));
}

TEST(Calibrate, PicturesAreNamedOneByOneOrByAGlobAndTheFileMayBeJson) {
  const TemporaryFolder stills, out;
  std::vector<std::string> names;
  for (std::size_t i = 0; i < good_places().size(); ++i) {
    names.push_back(stills.path("view_" + std::to_string(3 * i) + ".png"));
    cv::imwrite(names.back(), tag_board_frame(good_places()[i]));
  }
  std::vector<std::string> options = kTagBoard;
  options.insert(options.end(), names.begin() + 1, names.end());
  const CommandResult listed = calibrate(names.front(), out.path("listed.json"), options);
  expect_barrel_camera(listed, out.path("listed.json"));
  EXPECT_THAT(listed.output, HasSubstr("\n     27      48 "));
  EXPECT_TRUE(read_text(out.path("listed.json")).starts_with("{"));
  const CommandResult globbed = calibrate(stills.path("view_*.png"), out.path("globbed.json"), kTagBoard);
  EXPECT_EQ(globbed.output, listed.output);
  EXPECT_EQ(read_text(out.path("globbed.json")), read_text(out.path("listed.json")));
}

TEST(Calibrate, AFirstCameraComesFromTheShotsOwnTag) {
  Footage footage;
  for (const Placement& place : good_places()) footage.add(tag_board_frame(place));
  const TemporaryFolder out;
  const CommandResult result = calibrate(footage.pattern(), out.path("camera.json"), {"--from-tag", "10"});
  ASSERT_EQ(result.exit_code, 0) << result.error;
  EXPECT_THAT(result.error, HasSubstr("tag 10 of tag36h11 seen in 10 of 10 frames tried"));
  expect_within_stated(result.output, "focal length    ", 520, 0.05 * 520);
  const CameraModel camera = tracking::read_camera_file(out.path("camera.json"));
  EXPECT_EQ(camera.cx_px, 319.5);
  EXPECT_EQ(camera.fx_px, camera.fy_px);
  EXPECT_FALSE(camera.has_distortion());
}

TEST(CalibrateRefuses, ATagThatDoesNotTellTheFocalLength) {
  Footage frontal;
  for (int i = 0; i < 6; ++i) frontal.add(tag_board_frame({{250.0 + 20 * i, 240}, 0.35 + 0.03 * i, {0, 0, 10.0 * i}}));
  const TemporaryFolder out;
  const CommandResult result = calibrate(frontal.pattern(), out.path("camera.yaml"), {"--from-tag", "10"});
  EXPECT_EQ(result.exit_code, kFailure);
  EXPECT_THAT(result.error, AllOf(HasSubstr("stays frontal or hardly moves"), HasSubstr("calibrate with a board")));
  const CommandResult absent = calibrate(frontal.pattern(), out.path("camera.yaml"), {"--from-tag", "100"});
  EXPECT_THAT(absent.error, HasSubstr("tag 100 of tag36h11 was found in none of 6 frames"));
  const CommandResult both = calibrate(frontal.pattern(), out.path("camera.yaml"), {"--from-tag", "10", "--tags", "4x3"});
  EXPECT_EQ(both.exit_code, kUsage);
  EXPECT_THAT(both.error, HasSubstr("--from-tag takes the tag's id"));
  EXPECT_THAT(out.names(), ElementsAre());
}

// --- refusals -------------------------------------------------------------------------------------------------------------

TEST(CalibrateRefuses, FootageWithoutTheBoard) {
  Footage footage;
  for (int i = 0; i < 3; ++i) footage.add(tag_board_frame(good_places()[0], 100));
  const TemporaryFolder out;
  const CommandResult other_ids = calibrate(footage.pattern(), out.path("camera.yaml"), kTagBoard);
  EXPECT_EQ(other_ids.exit_code, kFailure);
  EXPECT_THAT(other_ids.error, HasSubstr("the board was found in none of 3 frames; is it described as it is (family, ids"));
  const CommandResult no_squares = calibrate(footage.pattern(), out.path("camera.yaml"), kCheckerboard);
  EXPECT_EQ(no_squares.exit_code, kFailure);
  EXPECT_THAT(no_squares.error, HasSubstr("inner corners, not squares"));
  EXPECT_THAT(out.names(), ElementsAre());
}

TEST(CalibrateRefuses, ViewsThatAreTooFewOrAllFrontal) {
  Footage few, frontal;
  for (int i = 0; i < 3; ++i) few.add(tag_board_frame(good_places()[i]));
  for (int i = 0; i < 6; ++i) frontal.add(tag_board_frame({{250.0 + 20 * i, 240}, 0.35 + 0.03 * i, {0, 0, 10.0 * i}}));
  const TemporaryFolder out;
  const CommandResult too_few = calibrate(few.pattern(), out.path("camera.yaml"), kTagBoard);
  EXPECT_EQ(too_few.exit_code, kFailure);
  EXPECT_THAT(too_few.error, HasSubstr("only 3 usable views of the board; at least 4 are needed"));
  const CommandResult all_frontal = calibrate(frontal.pattern(), out.path("camera.yaml"), kTagBoard);
  EXPECT_EQ(all_frontal.exit_code, kFailure);
  EXPECT_THAT(all_frontal.error, HasSubstr("do not determine the focal length"));
  EXPECT_THAT(out.names(), ElementsAre());
}

TEST(CalibrateRefuses, BadCommandLines) {
  const TemporaryFolder folder;
  const std::string yaml = folder.path("camera.yaml");
  const auto refused = [&](const std::string& footage, std::vector<std::string> options, const std::string& message,
                           int exit_code = kUsage) {
    const CommandResult result = calibrate(footage, yaml, std::move(options));
    EXPECT_EQ(result.exit_code, exit_code) << message;
    EXPECT_EQ(result.output, "");
    EXPECT_THAT(result.error, AllOf(HasSubstr("catchlight: error: "), HasSubstr(message)));
    EXPECT_THAT(folder.names(), ElementsAre());
  };
  refused("v.mp4", {}, "say which board is in the footage");
  refused("v.mp4", {"--checkerboard", "9x6", "--square-m", "1", "--tags", "4x3"}, "say which board is in the footage");
  refused("v.mp4", {"--checkerboard", "9x6"}, "--checkerboard needs --square-m");
  refused("v.mp4", {"--checkerboard", "9x2", "--square-m", "0.025"}, "--checkerboard is 9x2; expected the corners");
  refused("v.mp4", {"--checkerboard", "9x6", "--square-m", "0"}, "--square-m is 0; expected metres");
  refused("v.mp4", {"--tags", "1x1", "--size-m", "0.14"}, "--tags is 1x1, too few for a calibration");
  refused("v.mp4", {"--tags", "4x3", "--spacing-m", "0.05"}, "--tags needs --size-m");
  refused("v.mp4", {"--tags", "4x3", "--size-m", "0.04"}, "--tags needs --spacing-m");
  refused("v.mp4", {"--tags", "4x3", "--size-m", "0.05", "--spacing-m", "0.04"}, "--spacing-m is 0.04, from centre to centre");
  refused("v.mp4", {"--checkerboard", "9x6", "--square-m", "0.025", "--model", "fisheye"}, "--model");
  refused("v.mp4", {"--checkerboard", "9x6", "--square-m", "0.025", "--picture", folder.path("p.jpg")}, "ends in .png");
  refused("rtsp://127.0.0.1:1/x", {"--checkerboard", "9x6", "--square-m", "0.025", "--frames", "4:2"}, "--frames 4:2");
  refused("/nowhere/*.jpg", {"--checkerboard", "9x6", "--square-m", "0.025"}, "no file matches '/nowhere/*.jpg'", kFailure);
  refused("/nowhere/v.mp4", {"--checkerboard", "9x6", "--square-m", "0.025"}, "no such file: '/nowhere/v.mp4'", kFailure);
}

TEST(CalibrateRefuses, AFormatThatItDoesNotWrite) {
  const TemporaryFolder folder;
  const CommandResult result = calibrate("/nowhere/v.mp4", folder.path("camera.txt"), kCheckerboard);
  EXPECT_EQ(result.exit_code, kUsage);
  EXPECT_THAT(result.error, HasSubstr("camera.txt: expected a name that ends in .yaml, .yml, .json or .xml"));
}

TEST(CalibrateRefuses, ToOverwriteUnlessAllowed) {
  const TemporaryFolder folder;
  const std::string yaml = folder.write("camera.yaml", "mine");
  const CommandResult result = calibrate("/nowhere/v.mp4", yaml, kCheckerboard);
  EXPECT_EQ(result.exit_code, kUsage);
  EXPECT_THAT(result.error, HasSubstr("exists already; pass -y"));
  EXPECT_EQ(read_text(yaml), "mine");
}

// --- real pictures --------------------------------------------------------------------------------------------------------

/// OpenCV's own example, from Debian's package opencv-doc. Others find f = 533 to 536 px there, (342, 234) and k1 = -0.27 to
/// -0.29 (OpenCV's tutorials, Bouguet's toolbox).
TEST(CalibrateRealPictures, OpenCvsExampleGivesTheCameraThatOthersFind) {
  const char* named = std::getenv("CATCHLIGHT_CHECKERBOARDS");
  const fs::path samples = named ? named : "/usr/share/doc/opencv-doc/examples/data";
  if (!fs::exists(samples / "left01.jpg"))
    GTEST_SKIP() << "no left01.jpg in " << samples << "; install opencv-doc or set "
                 << "CATCHLIGHT_CHECKERBOARDS";
  const TemporaryFolder out;
  // There is no left10.jpg.
  const CommandResult result = calibrate((samples / "left%02d.jpg").string(), out.path("camera.json"), kCheckerboard);
  ASSERT_EQ(result.exit_code, 0) << result.error;
  EXPECT_THAT(result.error, HasSubstr("board seen in 13 of 13 frames tried, of 13"));
  EXPECT_THAT(result.output, ::testing::ContainsRegex("\n +14 +54 "));
  const CameraModel camera = tracking::read_camera_file(out.path("camera.json"));
  EXPECT_NEAR(camera.fx_px, 534.5, 3);
  EXPECT_NEAR(camera.fy_px, 534.5, 3);
  EXPECT_NEAR(camera.cx_px, 342, 2);
  EXPECT_NEAR(camera.cy_px, 234, 2);
  EXPECT_NEAR(camera.distortion[0], -0.28, 0.025);
  EXPECT_THAT(result.output, Not(HasSubstr("rejected")));
}

}  // namespace
}  // namespace catchlight::tests
