// What the window's picture can show, by scripts.
#include <gmock/gmock.h>

#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>
#include <string>
#include <vector>

#include "tests/support/run_command.hpp"
#include "tests/support/temporary_folder.hpp"

namespace catchlight::tests {
namespace {

const std::string kRecordings = std::string(CATCHLIGHT_SOURCE_DIR) + "/recordings/", kMatte = kRecordings + "matte",
                  kGloss = kRecordings + "gloss";

/// How far two pictures of the window are apart where the footage is shown.
double difference_in_picture(const std::string& one, const std::string& other) {
  const cv::Rect picture(72, 42, 764, 572);
  return cv::norm(cv::imread(one)(picture), cv::imread(other)(picture), cv::NORM_L1) / picture.area();
}

TEST(TuneViews, EachShowsAnotherPictureAndLeavesTheComposite) {
  const TemporaryFolder folder;
  const std::vector<std::string> views = {"plate",      "truth",  "split", "difference", "zones", "object",
                                          "reflection", "shadow", "glare", "normals",    "depth"};
  std::string script =
      "seek 5\nwait\nscreenshot " + folder.path("composite.png") + "\npicture " + folder.path("before.png") + "\n";
  for (const std::string& view : views)
    script += "click view\nclick view " + view + "\nwait\nscreenshot " + folder.path(view + ".png") + "\nwait\n";
  script += "picture " + folder.path("after.png") + "\nquit\n";
  const CommandResult result = run_catchlight({"tune", kMatte, "--headless", "--ui-script", folder.write("views.txt", script)});
  ASSERT_EQ(result.exit_code, 0) << result.error;
  for (const std::string& view : views)
    EXPECT_GT(difference_in_picture(folder.path(view + ".png"), folder.path("composite.png")), 0.1) << view;
  const cv::Mat before = cv::imread(folder.path("before.png")), after = cv::imread(folder.path("after.png"));
  EXPECT_EQ(cv::norm(before, after, cv::NORM_INF), 0) << "the composite is the same whatever is looked at";
}

TEST(TuneViews, OverlaysAreSwitchedOnAndOffAndLeaveTheComposite) {
  const TemporaryFolder folder;
  const std::vector<std::string> overlays = {"tag", "axes", "residual", "state", "object", "shadow", "receiver"};
  const auto toggle = [](const std::string& overlay) {
    return "click overlays\nclick overlay " + overlay + "\nclick overlays\nwait\n";
  };
  std::string script =
      "wait\nseek 5\nwait\nscreenshot " + folder.path("composite.png") + "\npicture " + folder.path("before.png") + "\n";
  for (const std::string& overlay : overlays)
    script += toggle(overlay) + "screenshot " + folder.path(overlay + ".png") + "\nwait\n" + toggle(overlay);
  script += "screenshot " + folder.path("off.png") + "\npicture " + folder.path("after.png") + "\nwait\nquit\n";
  const CommandResult result = run_catchlight({"tune", kMatte, "--headless", "--ui-script", folder.write("over.txt", script)});
  ASSERT_EQ(result.exit_code, 0) << result.error;
  for (const std::string& overlay : overlays)
    EXPECT_GT(difference_in_picture(folder.path(overlay + ".png"), folder.path("composite.png")), 0.02) << overlay;
  EXPECT_EQ(difference_in_picture(folder.path("off.png"), folder.path("composite.png")), 0);
  const cv::Mat before = cv::imread(folder.path("before.png")), after = cv::imread(folder.path("after.png"));
  EXPECT_EQ(cv::norm(before, after, cv::NORM_INF), 0);
}

TEST(TuneViews, EachLightIsSeenAlone) {
  const TemporaryFolder folder;
  std::string script =
      "wait\nseek 5\nwait\nscreenshot " + folder.path("composite.png") + "\npicture " + folder.path("before.png") + "\n";
  for (const std::string view : {"environment", "light 1", "light 2"})
    script +=
        "click view\nclick view " + view + "\nwait\nscreenshot " + folder.path(view.substr(view.size() - 1)) + ".png\nwait\n";
  script += "picture " + folder.path("after.png") + "\nquit\n";
  const CommandResult result = run_catchlight({"tune", kGloss, "--headless", "--ui-script", folder.write("lights.txt", script)});
  ASSERT_EQ(result.exit_code, 0) << result.error;
  const std::string composite = folder.path("composite.png"), environment = folder.path("t.png"), first = folder.path("1.png"),
                    second = folder.path("2.png");
  for (const std::string& view : {environment, first, second}) EXPECT_GT(difference_in_picture(view, composite), 10) << view;
  EXPECT_GT(difference_in_picture(first, second), 1);
  EXPECT_GT(difference_in_picture(first, environment), 1);
  EXPECT_EQ(cv::norm(cv::imread(folder.path("before.png")), cv::imread(folder.path("after.png")), cv::NORM_INF), 0);
}

TEST(TuneViews, AClickIntoThePoseErrorGoesToItsFrame) {
  const TemporaryFolder folder;
  const std::string script =
      "wait\nclick pose error\nclick waveform\nwait\nclick waveform\nclick pose error curve\nwait\nexpect frame 18\n"
      "drag pose error curve 0.5 0.999\nwait\nexpect frame 35\nquit\n";
  const CommandResult result = run_catchlight({"tune", kMatte, "--headless", "--ui-script", folder.write("pose.txt", script)});
  EXPECT_EQ(result.exit_code, 0) << result.error;
}

}  // namespace
}  // namespace catchlight::tests
