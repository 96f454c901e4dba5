// The program as users run it: what it prints, where, and how it ends.
#include <gmock/gmock.h>

#include <opencv2/imgcodecs.hpp>

#include "catchlight/image.hpp"
#include "render/probe/probe.hpp"
#include "tests/support/run_command.hpp"
#include "tests/support/temporary_folder.hpp"

namespace catchlight::tests {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::StartsWith;

constexpr int kFailure = 1, kUsage = 2;

/// One message on stderr, nothing on stdout.
void expect_error(const CommandResult& result, int exit_code, const std::string& message) {
  EXPECT_EQ(result.exit_code, exit_code);
  EXPECT_EQ(result.output, "");
  EXPECT_THAT(result.error, StartsWith("catchlight: error: "));
  EXPECT_THAT(result.error, HasSubstr(message));
}

std::string matte() {
  return CATCHLIGHT_SOURCE_DIR "/recordings/matte";
}
std::string matte_probe() {
  return matte() + "/probe.exr";
}

// --- the program itself ---------------------------------------------------------------------------------------------------

TEST(Program, VersionIsOnStdout) {
  const CommandResult result = run_catchlight({"--version"});
  EXPECT_EQ(result.exit_code, 0);
  EXPECT_THAT(result.output, ::testing::MatchesRegex("catchlight [0-9]+\\.[0-9]+\\.[0-9]+\n"));
  EXPECT_EQ(result.error, "");
}

TEST(Program, HelpNamesEveryCommand) {
  const CommandResult result = run_catchlight({"--help"});
  EXPECT_EQ(result.exit_code, 0);
  for (const char* command : {"overlay", "track", "replay", "reference", "bake", "probe", "tag", "calibrate", "info", "params"})
    EXPECT_THAT(result.output, HasSubstr(command));
}

// OpenCV's image files alone bring GDAL and a hundred libraries more, and took the program four times as long to start.
TEST(Program, StartsWithoutLibrariesThatFewRunsNeed) {
  const CommandResult loaded = run_catchlight({"--version"}, {{"LD_TRACE_LOADED_OBJECTS", "1"}});
  EXPECT_THAT(loaded.output, HasSubstr("libavcodec")) << "the loader lists what it loads";
  for (const char* library : {"libopencv_imgcodecs", "libgdal", "libavfilter", "libavdevice"})
    EXPECT_THAT(loaded.output, ::testing::Not(HasSubstr(library)));
}

TEST(Program, HelpOfACommandShowsItsOptions) {
  const CommandResult result = run_catchlight({"bake", "--help"});
  EXPECT_EQ(result.exit_code, 0);
  for (const char* text : {"RECORDING", "--scene", "--camera", "--fov", "--quality.rays"})
    EXPECT_THAT(result.output, HasSubstr(text));
}

TEST(Program, OptionOfAnotherCommandNamesThat) {
  expect_error(
      run_catchlight({"track", "somewhere", "-o", "t.csv", "--renderer", "cpu"}), kUsage,
      "`catchlight track` has no option --renderer; it is one of `catchlight overlay`, `catchlight tune`, `catchlight replay`");
}

TEST(Program, MistypedCommandNamesTheNearest) {
  expect_error(run_catchlight({"bka"}), kUsage, "unknown command 'bka'; did you mean 'bake'?");
}

TEST(Program, MistypedOptionNamesTheNearest) {
  expect_error(run_catchlight({"bake", "somewhere", "--glare.enabld", "true"}), kUsage,
               "unknown option --glare.enabld; did you mean --glare.enabled?");
  expect_error(run_catchlight({"probe", "info", "a.exr", "--stict"}), kUsage, "unknown option --stict; did you mean --strict?");
}

TEST(Program, MissingArgumentSaysWhereHelpIs) {
  const CommandResult result = run_catchlight({"probe", "convert", "a.exr"});
  expect_error(result, kUsage, "OUT is required");
  EXPECT_THAT(result.error, HasSubstr("`catchlight probe convert --help`"));
}

TEST(Program, OneArgumentTooMany) {
  expect_error(run_catchlight({"probe", "info", "a.exr", "b.exr"}), kUsage, "unexpected argument 'b.exr'");
}

// --- params -----------------------------------------------------------------------------------------------------------------

TEST(Params, MarkdownIsThePageInTheDocumentation) {
  const CommandResult result = run_catchlight({"params", "--markdown"});
  EXPECT_EQ(result.exit_code, 0);
  EXPECT_TRUE(result.output == read_text(CATCHLIGHT_SOURCE_DIR "/docs/parameters.md"));
}

TEST(Params, ListShowsDefaultsAndRanges) {
  EXPECT_THAT(run_catchlight({"params"}).output, HasSubstr("tag.size_m = 0.08\n"));
  EXPECT_THAT(run_catchlight({"params"}).output, HasSubstr("Expected: a number from 0.001 to 100 m.\n"));
}

// --- info -------------------------------------------------------------------------------------------------------------------

TEST(Info, NamesWhatABugReportNeeds) {
  const CommandResult result = run_catchlight({"info"});
  for (const char* name : {"Catchlight", "libavformat", "libavcodec", "OpenCV", "OpenEXR", "Embree", "tag36h11", "Processor"})
    EXPECT_THAT(result.output, HasSubstr(name));
  EXPECT_EQ(result.exit_code, 0);
  EXPECT_THAT(result.output, HasSubstr("--renderer auto"));
}

TEST(Info, WithoutGraphicsSaysWhyAndWhatDraws) {
  // A vendor list that holds nothing leaves no EGL driver.
  const CommandResult result = run_catchlight({"info"}, {{"__EGL_VENDOR_LIBRARY_FILENAMES", "/nonexistent.json"}});
  EXPECT_EQ(result.exit_code, 0);
  EXPECT_THAT(result.output, HasSubstr("none: "));
  EXPECT_THAT(result.output, HasSubstr("auto    cpu"));
  EXPECT_THAT(result.output, HasSubstr("Embree"));
}

// --- probe ------------------------------------------------------------------------------------------------------------------

/// A small probe, brighter above, and a folder for what is made from it.
struct ProbeFolder : TemporaryFolder {
  ProbeFolder() {
    render::Probe probe{Image(32, 16), render::ProbeLayout::latlong};
    for (int y = 0; y < 16; ++y)
      for (int x = 0; x < 32; ++x)
        for (int c = 0; c < 3; ++c) probe.image.pixel(x, y)[c] = y < 8 ? 2.0f : 0.5f;
    render::save_probe(path("probe.exr"), probe);
  }
};

TEST(ProbeInfo, PrintsFiguresOnStdout) {
  const ProbeFolder folder;
  const CommandResult result = run_catchlight({"probe", "info", folder.path("probe.exr")});
  EXPECT_EQ(result.exit_code, 0) << result.error;
  EXPECT_THAT(result.output, HasSubstr("32x16"));
  EXPECT_THAT(result.output, HasSubstr("latlong"));
  EXPECT_THAT(result.output, HasSubstr("max 2, min above 0 0.5"));
  EXPECT_THAT(result.output, HasSubstr("2 EV"));
  EXPECT_THAT(result.output, HasSubstr("SH band 2"));
}

TEST(ProbeInfo, MissingFileIsNamed) {
  expect_error(run_catchlight({"probe", "info", "/nowhere/p.exr"}), kFailure, "/nowhere/p.exr");
}

TEST(ProbeInfo, WhatIsNoProbeIsNamed) {
  const TemporaryFolder folder;
  const std::string path = folder.write("p.exr", "this is not a picture");
  expect_error(run_catchlight({"probe", "info", path}), kFailure, path);
}

TEST(ProbeInfo, UnknownLayoutNamesThoseThereAre) {
  const ProbeFolder folder;
  const CommandResult result = run_catchlight({"probe", "info", folder.path("probe.exr"), "--layout-in", "ball"});
  EXPECT_NE(result.exit_code, 0);
  EXPECT_THAT(result.error, HasSubstr("mirror-ball"));
}

TEST(ProbeInfo, NegativeTexelsAreWarnedOfAndRefusedWhenStrict) {
  const TemporaryFolder folder;
  render::Probe probe{Image(32, 16), render::ProbeLayout::latlong};
  for (float& value : probe.image.data) value = 1;
  probe.image.pixel(3, 4)[1] = -0.5f;
  render::save_probe(folder.path("bad.exr"), probe);
  const CommandResult lenient = run_catchlight({"probe", "info", folder.path("bad.exr")});
  EXPECT_EQ(lenient.exit_code, 0);
  EXPECT_THAT(lenient.error, StartsWith("catchlight: warning: " + folder.path("bad.exr")));
  expect_error(run_catchlight({"probe", "info", folder.path("bad.exr"), "--strict"}), kFailure, folder.path("bad.exr"));
}

TEST(ProbeInfo, QuietSilencesWarnings) {
  const TemporaryFolder folder;
  render::save_probe(folder.path("black.exr"), {Image(32, 16), render::ProbeLayout::latlong});
  EXPECT_NE(run_catchlight({"probe", "info", folder.path("black.exr")}).error, "");
  EXPECT_EQ(run_catchlight({"probe", "info", "-q", folder.path("black.exr")}).error, "");
  EXPECT_EQ(run_catchlight({"-q", "probe", "info", folder.path("black.exr")}).error, "");
}

TEST(ProbeConvert, EveryLayoutIsWrittenAndKeepsTheMeanLight) {
  const ProbeFolder folder;
  for (const char* layout : {"latlong", "angular", "mirror-ball", "cube-cross", "cube"}) {
    const std::string out = folder.path(std::string(layout) + ".exr");
    const CommandResult result =
        run_catchlight({"probe", "convert", folder.path("probe.exr"), out, "--layout", layout, "--width", "48"});
    EXPECT_EQ(result.exit_code, 0) << layout << ": " << result.error;
    render::ProbeLoadOptions options;
    options.layout = render::probe_layout_from_name(layout);
    const render::Probe probe = render::load_probe(out, options, [](const std::string& warning) { ADD_FAILURE() << warning; });
    EXPECT_EQ(probe.image.width, 48) << layout;
    const double up = render::irradiance(probe, {0, 1, 0}).g;
    EXPECT_NEAR(up, render::irradiance({render::load_probe(folder.path("probe.exr"), {}, {})}, {0, 1, 0}).g, 0.05 * up) << layout;
  }
}

TEST(ProbeConvert, ExistingOutputIsKeptUnlessAllowed) {
  const ProbeFolder folder;
  const std::string out = folder.write("out.exr", "mine");
  expect_error(run_catchlight({"probe", "convert", folder.path("probe.exr"), out, "--layout", "cube"}), kUsage,
               out + ": exists already; pass -y");
  EXPECT_EQ(read_text(out), "mine");
  EXPECT_EQ(run_catchlight({"probe", "convert", folder.path("probe.exr"), out, "--layout", "cube", "-y"}).exit_code, 0);
  EXPECT_NE(read_text(out), "mine");
}

TEST(ProbeConvert, UnknownExtensionNamesTheOutputAndLeavesNothing) {
  const ProbeFolder folder;
  const std::string out = folder.path("out.tiff");
  expect_error(run_catchlight({"probe", "convert", folder.path("probe.exr"), out, "--layout", "cube"}), kUsage, out + ": ");
  EXPECT_THAT(folder.names(), ElementsAre("probe.exr"));
}

TEST(ProbeConvert, MissingOutputFolderIsNamed) {
  const ProbeFolder folder;
  expect_error(run_catchlight({"probe", "convert", folder.path("probe.exr"), folder.path("no/out.exr"), "--layout", "cube"}),
               kFailure, "there is no folder " + folder.path("no"));
}

TEST(ProbeSh, TextStatesItsConvention) {
  const ProbeFolder folder;
  const CommandResult result = run_catchlight({"probe", "sh", folder.path("probe.exr"), "--bands", "2"});
  EXPECT_EQ(result.exit_code, 0) << result.error;
  EXPECT_THAT(result.output, HasSubstr("without the Condon-Shortley phase"));
  // 4 pi * mean * y(0,0), the mean of 2 above and 0.5 below being 1.25; and light from above is along +y.
  EXPECT_THAT(result.output, HasSubstr("\n0 0 4.43"));
  EXPECT_THAT(result.output, HasSubstr("\n1 -1 2.3"));
  EXPECT_THAT(result.output, HasSubstr("\n1 1 "));
}

TEST(ProbeSh, FileHoldsWhatStdoutWould) {
  const ProbeFolder folder;
  const CommandResult printed = run_catchlight({"probe", "sh", folder.path("probe.exr")});
  const CommandResult written = run_catchlight({"probe", "sh", folder.path("probe.exr"), "-o", folder.path("sh.txt")});
  EXPECT_EQ(written.exit_code, 0);
  EXPECT_EQ(written.output, "");
  EXPECT_EQ(read_text(folder.path("sh.txt")), printed.output);
}

TEST(ProbeSh, TooManyBandsAreAUsageError) {
  EXPECT_EQ(run_catchlight({"probe", "sh", matte_probe(), "--bands", "99"}).exit_code, kUsage);
}

TEST(ProbeBall, IsAPictureWithTheSkyOnTop) {
  const ProbeFolder folder;
  const std::string out = folder.path("ball.png");
  const CommandResult result =
      run_catchlight({"probe", "ball", folder.path("probe.exr"), "-o", out, "--size", "64", "--ev", "-1.5"});
  EXPECT_EQ(result.exit_code, 0) << result.error;
  const cv::Mat ball = cv::imread(out, cv::IMREAD_UNCHANGED);
  ASSERT_EQ(ball.size(), cv::Size(64, 64));
  ASSERT_EQ(ball.type(), CV_8UC4);
  // sRGB of 2 * 2^-1.5 and 0.5 * 2^-1.5.
  EXPECT_NEAR(ball.at<cv::Vec4b>(16, 32)[0], 219, 1);
  EXPECT_NEAR(ball.at<cv::Vec4b>(47, 32)[0], 117, 1);
  EXPECT_EQ(ball.at<cv::Vec4b>(0, 0)[3], 0);
}

TEST(ProbeBall, OtherExtensionIsAUsageError) {
  expect_error(run_catchlight({"probe", "ball", matte_probe(), "-o", "ball.jpg"}), kUsage, "ball.jpg: the preview is a PNG");
}

// --- bake -------------------------------------------------------------------------------------------------------------------

TEST(Bake, IsReportedAndThenTakenFromTheCache) {
  const ProbeFolder folder;
  const std::vector<std::string> command{"bake",
                                         matte(),
                                         "--probe.image",
                                         folder.path("probe.exr"),
                                         "--quality.rays",
                                         "16",
                                         "--quality.bands=2",
                                         "--quality.bounces=0",
                                         "--quality.receiver_points=8",
                                         "--verbose"};
  const std::map<std::string, std::string> environment{{"XDG_CACHE_HOME", folder.path("cache")}};
  const CommandResult first = run_catchlight(command, environment);
  EXPECT_EQ(first.exit_code, 0) << first.error;
  EXPECT_EQ(first.output, "");
  EXPECT_THAT(first.error, ::testing::ContainsRegex("8x[0-9]+ receiver points, 2 bands, 16 rays, baked in "));
  EXPECT_THAT(first.error, HasSubstr("rays = 16: set by hand"));
  EXPECT_THAT(run_catchlight(command, environment).error, HasSubstr("16 rays, taken from the cache in "));
}

TEST(Bake, NoSuchRecording) {
  expect_error(run_catchlight({"bake", "/nowhere"}), kFailure, "/nowhere: no such file or folder");
}

TEST(Bake, ParameterOutOfRangeNamesTheOption) {
  expect_error(run_catchlight({"bake", matte(), "--quality.bands", "99"}), kUsage,
               "--quality.bands is 99; expected a whole number from 1 to 10");
}

TEST(Bake, UnknownKeyInTheSceneNamesLineAndNearestKey) {
  const TemporaryFolder folder;
  const std::string scene = folder.write("scene.toml", "[glare]\nenabld = true\n");
  expect_error(run_catchlight({"bake", matte(), "--scene", scene}), kFailure,
               scene + ":2:1: unknown key 'glare.enabld'; did you mean 'glare.enabled'?");
}

}  // namespace
}  // namespace catchlight::tests
