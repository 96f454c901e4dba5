// `catchlight probe split`: a probe as its lights and its rest. `probe make`: probes that need no file.
#include <gmock/gmock.h>

#include <regex>

#include "catchlight/image.hpp"
#include "render/made_probe/made_probe.hpp"
#include "render/probe/probe.hpp"
#include "tests/support/run_command.hpp"
#include "tests/support/temporary_folder.hpp"

namespace catchlight::tests {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::Not;

constexpr int kUsage = 2;

/// A grey sky whose light is uneven enough for no two texels to be alike.
render::Probe sky() {
  render::Probe probe{Image(64, 32), render::ProbeLayout::latlong};
  for (int y = 0; y < 32; ++y) {
    for (int x = 0; x < 64; ++x) {
      for (int c = 0; c < 3; ++c) probe.image.pixel(x, y)[c] = 0.3f + 0.001f * static_cast<float>((17 * x + 5 * y + 3 * c) % 97);
    }
  }
  return probe;
}

/// A patch of 2 x 2 texels.
void add_lamp(render::Probe& probe, int x, int y, const glm::vec3& radiance) {
  for (int i = 0; i < 4; ++i) {
    for (int c = 0; c < 3; ++c) probe.image.pixel(x + i % 2, y + i / 2)[c] += radiance[c];
  }
}

/// probe.exr, in float, and room for its parts.
struct ProbeFile : TemporaryFolder {
  explicit ProbeFile(const render::Probe& probe) { render::save_probe(path("probe.exr"), probe, render::ExrPrecision::full); }
};

render::Probe two_lamps() {
  render::Probe probe = sky();
  add_lamp(probe, 12, 6, {3e5f, 2e5f, 1e5f});  // beyond what half holds
  add_lamp(probe, 44, 12, {900, 1200, 1500});
  return probe;
}

render::Probe loaded(const std::string& path) {
  return render::load_probe(path, {}, [](const std::string& warning) { ADD_FAILURE() << warning; });
}

TEST(ProbeSplit, BothPartsAddUpToTheProbe) {
  const ProbeFile folder(two_lamps());
  const std::string lights_path = folder.path("lights.exr"), rest_path = folder.path("rest.exr");
  const CommandResult result =
      run_catchlight({"probe", "split", folder.path("probe.exr"), "--lights", lights_path, "--rest", rest_path});
  ASSERT_EQ(result.exit_code, 0) << result.error;
  const render::Probe whole = loaded(folder.path("probe.exr")), lights = loaded(lights_path), rest = loaded(rest_path);
  ASSERT_EQ(lights.image.data.size(), whole.image.data.size());
  ASSERT_EQ(rest.image.data.size(), whole.image.data.size());
  int lit = 0;
  for (std::size_t i = 0; i < whole.image.data.size(); ++i) {
    EXPECT_FLOAT_EQ(lights.image.data[i] + rest.image.data[i], whole.image.data[i]) << i;
    lit += lights.image.data[i] > 0;
  }
  EXPECT_EQ(lit, 2 * 4 * 3);  // texels of the two lamps alone
  for (const float value : rest.image.data) EXPECT_LT(value, 100);
}

TEST(ProbeSplit, PrintsTheLightsBrightestFirst) {
  const ProbeFile folder(two_lamps());
  const CommandResult result = run_catchlight({"probe", "split", folder.path("probe.exr")});
  EXPECT_EQ(result.exit_code, 0) << result.error;
  EXPECT_EQ(result.error, "");
  EXPECT_THAT(result.output, HasSubstr("lights               2\n"));
  // Rows 6 and 7 of 32 from 90 to -90 degrees lie at 55.16 and 49.35, the lower one wider; of 64 columns from 180 to -180 degrees
  // 12 and 13 have their middle at 108.6, 44 and 45 at -74.29.
  EXPECT_THAT(result.output, HasSubstr("latitude 52.1"));
  EXPECT_THAT(result.output, HasSubstr("longitude 108.6"));
  EXPECT_LT(result.output.find("longitude 108.6"), result.output.find("longitude -74.29"));
  EXPECT_THAT(folder.names(), ElementsAre("probe.exr"));
}

/// A share is at most all of the light: one lamp of the two gives 200 times the other's.
TEST(ProbeSplit, SharesAreOfTheWholeProbesLight) {
  const ProbeFile folder(two_lamps());
  const std::string output = run_catchlight({"probe", "split", folder.path("probe.exr")}).output;
  std::vector<double> shares;
  const std::regex line("share +([0-9.]+) % of all the probe's light\n");
  for (std::sregex_iterator match(output.begin(), output.end(), line), end; match != end; ++match)
    shares.push_back(std::stod((*match)[1]));
  ASSERT_EQ(shares.size(), 2U) << output;
  EXPECT_GT(shares[0], 99);
  EXPECT_GT(shares[1], 0.3);
  EXPECT_LE(shares[0] + shares[1], 100);
}

TEST(ProbeSplit, EvenLightHasNoLights) {
  const ProbeFile folder(sky());
  const std::string lights = folder.path("lights.exr"), rest = folder.path("rest.exr");
  const CommandResult result =
      run_catchlight({"probe", "split", folder.path("probe.exr"), "--lights", lights, "--rest", rest, "-q"});
  EXPECT_EQ(result.exit_code, 0) << result.error;
  EXPECT_EQ(result.output, "lights               0\n");
  EXPECT_EQ(loaded(rest).image.data, loaded(folder.path("probe.exr")).image.data);
  for (const float value : render::load_probe(lights, {}, {}).image.data) EXPECT_EQ(value, 0);
}

TEST(ProbeSplit, WithoutSamplesThereAreNoLights) {
  const ProbeFile folder(two_lamps());
  EXPECT_EQ(run_catchlight({"probe", "split", folder.path("probe.exr"), "--samples", "0"}).output, "lights               0\n");
}

TEST(ProbeSplit, ToleranceDecidesWhatIsWorthALight) {
  const ProbeFile folder(two_lamps());
  const CommandResult coarse = run_catchlight({"probe", "split", folder.path("probe.exr"), "--tolerance", "0.1"});
  EXPECT_THAT(coarse.output, HasSubstr("lights               1\n"));
  EXPECT_THAT(coarse.output, Not(HasSubstr("longitude -74")));
}

TEST(ProbeSplit, AnotherFormatThanExrIsAUsageError) {
  const ProbeFile folder(sky());
  const CommandResult result =
      run_catchlight({"probe", "split", folder.path("probe.exr"), "--lights", folder.path("lights.exr"), "--rest", "rest.hdr"});
  EXPECT_EQ(result.exit_code, kUsage);
  EXPECT_THAT(result.error, HasSubstr("rest.hdr: "));
  EXPECT_THAT(folder.names(), ElementsAre("probe.exr"));
}

TEST(ProbeSplit, OneFileForBothPartsIsAUsageError) {
  const ProbeFile folder(sky());
  const std::string out = folder.path("parts.exr");
  const CommandResult result = run_catchlight({"probe", "split", folder.path("probe.exr"), "--lights", out, "--rest", out});
  EXPECT_EQ(result.exit_code, kUsage);
  EXPECT_THAT(result.error, HasSubstr("parts.exr: "));
  EXPECT_THAT(folder.names(), ElementsAre("probe.exr"));
}

TEST(ProbeSplit, AnOutputThatExistsKeepsBothFromBeingWritten) {
  const ProbeFile folder(two_lamps());
  const std::string lights = folder.path("lights.exr"), rest = folder.write("rest.exr", "mine");
  const CommandResult result = run_catchlight({"probe", "split", folder.path("probe.exr"), "--lights", lights, "--rest", rest});
  EXPECT_EQ(result.exit_code, kUsage);
  EXPECT_THAT(result.error, HasSubstr(rest));
  EXPECT_EQ(read_text(rest), "mine");
  EXPECT_THAT(folder.names(), ElementsAre("probe.exr", "rest.exr"));
}

TEST(ProbeSplit, OptionsOutOfRangeAreNamed) {
  const ProbeFile folder(sky());
  const std::vector<std::vector<std::string>> wrong{{"--bands", "11"}, {"--tolerance", "0"}, {"--samples", "1000"}};
  for (const std::vector<std::string>& option : wrong) {
    const CommandResult result = run_catchlight({"probe", "split", folder.path("probe.exr"), option[0], option[1]});
    EXPECT_EQ(result.exit_code, kUsage);
    EXPECT_THAT(result.error, HasSubstr(option[0]));
  }
}

TEST(ProbeMake, WritesWhatASceneIsLitBy) {
  const TemporaryFolder folder;
  for (const std::string name : {"overcast", "studio", "sky:sun_elevation_deg=35,turbidity=4"}) {
    const CommandResult result = run_catchlight({"probe", "make", name, "-o", folder.path("made.exr"), "-y"});
    ASSERT_EQ(result.exit_code, 0) << result.error;
    const render::Probe written = render::load_probe(folder.path("made.exr"), {}, {});
    EXPECT_TRUE(written.image.data == render::make_probe(name).image.data) << name;
  }
}

TEST(ProbeMake, RefusesInOneLine) {
  const TemporaryFolder folder;
  const std::string made = folder.path("made.exr");
  const auto error = [](const std::string& name, const std::string& output) {
    const CommandResult result = run_catchlight({"probe", "make", name, "-o", output});
    EXPECT_NE(result.exit_code, 0) << name;
    EXPECT_EQ(std::ranges::count(result.error, '\n'), 1) << result.error;
    return result.error;
  };
  EXPECT_THAT(error("studo", made), HasSubstr("did you mean \"studio\"?"));
  EXPECT_THAT(error("sky:sun_elevation_deg=-3", made), HasSubstr("the sky's model has its sun above the horizon"));
  EXPECT_THAT(error("sky", folder.path("made.png")), HasSubstr("ends in .exr"));
  folder.write("made.exr", "kept");
  EXPECT_THAT(error("sky", made), HasSubstr("made.exr"));
}

// What reads a probe takes its name as well.
TEST(ProbeMake, NamesStandForFiles) {
  EXPECT_THAT(run_catchlight({"probe", "info", "overcast"}).output, HasSubstr("irradiance up        3.142 3.142 3.142"));
}

}  // namespace
}  // namespace catchlight::tests
