// What a user is told where the tag's views and the camera given do not agree.
#include "app/session/focal_check.hpp"
#include "tracking/camera/camera_file.hpp"

#include <gmock/gmock.h>

namespace catchlight::app {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

std::vector<std::string> warnings_for(double fov_deg, const tracking::FocalEstimate& seen) {
  Log log;
  log.set_quiet(true);
  Recording recording;
  recording.fov_deg = fov_deg;
  tell_focal_length(seen, tracking::camera_from_field_of_view(640, 480, fov_deg), recording, log);
  return log.warnings();
}

/// 640 px wide at 60 degrees: 554 px.
TEST(FocalCheck, WarnsBeyondThreePercentWithTheAngleToPass) {
  EXPECT_THAT(warnings_for(60, {554, 5, 12}), IsEmpty());
  EXPECT_THAT(warnings_for(60, {540, 5, 12}), IsEmpty()) << "2.6 %";
  EXPECT_THAT(warnings_for(60, {640, 5, 12}),
              ElementsAre(AllOf(HasSubstr("12 views of the tag say 640 +- 5 px, --fov 60 says 554"), HasSubstr("13 % too short"),
                                HasSubstr("pass --fov 53.1"))));
  EXPECT_THAT(warnings_for(60, {500, 5, 12}), ElementsAre(HasSubstr("11 % too long")));
}

TEST(FocalCheck, DoesNotWarnOfWhatMayBeNoise) {
  EXPECT_THAT(warnings_for(60, {590, 20, 12}), IsEmpty());
}

}  // namespace
}  // namespace catchlight::app
