// The program on processors without AVX: it draws the same picture.
#ifdef CATCHLIGHT_WITHOUT_AVX
#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>

#include "tests/app/commands/overlay_command.hpp"

namespace catchlight::tests {
namespace {

/// Embree's intersections round otherwise without fused multiplication: here and there a ray goes another way. All else is the
/// same to the bit.
TEST_F(OverlayCommand, WithoutAvxDrawsTheSamePicture) {
  const std::string copy = copied_recording(1, "gloss");
  const auto arguments = [&](const std::string& name) -> std::vector<std::string> {
    return {"overlay",
            copy,
            "-o",
            folder_.path(name),
            "--renderer",
            "cpu",
            "--quality.rays=16",
            "--quality.bands=3",
            "--quality.receiver_points=16",
            "--quality.reflection_rays=4",
            "--quality.light_samples=8"};
  };
  const CommandResult without = run_program(CATCHLIGHT_WITHOUT_AVX, arguments("without.%04d.png"),
                                            {{"GLIBC_TUNABLES", "glibc.cpu.hwcaps=-AVX,-AVX2,-FMA,-AVX512F"},
                                             {"OPENCV_CPU_DISABLE", "AVX,FP16,FMA3,AVX2,AVX512_SKX"},
                                             {"XDG_CACHE_HOME", folder_.path("a")}});
  ASSERT_EQ(without.exit_code, 0) << without.error;
  const CommandResult with = run_catchlight(arguments("with.%04d.png"), {{"XDG_CACHE_HOME", folder_.path("b")}});
  ASSERT_EQ(with.exit_code, 0) << with.error;
  const cv::Mat a = cv::imread(folder_.path("without.0000.png")), b = cv::imread(folder_.path("with.0000.png"));
  ASSERT_EQ(a.size(), b.size());
  cv::Mat apart;
  cv::absdiff(a, b, apart);
  EXPECT_LE(cv::norm(apart, cv::NORM_INF), 4);
  EXPECT_LE(cv::countNonZero(apart.reshape(1)), 300);
}

}  // namespace
}  // namespace catchlight::tests
#endif
