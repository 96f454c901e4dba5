#include "app/session/report.hpp"

#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

#include "tests/support/temporary_folder.hpp"

namespace catchlight::app {
namespace {

using ::testing::HasSubstr;

Report example() {
  Report report;
  report.frames = 36;
  report.tracked_frames = 33;
  report.coasting_frames = 2;
  report.lost_frames = 1;
  report.fps = 4.25;
  report.glare_frames = 12;
  report.glare_share = 0.25;
  report.renderer = "llvmpipe";
  report.plan = {{"bands", "6", "default"}, {"rays", "256", "for a tolerance of 0.02"}};
  report.warnings = {"probe.exr: 3 texels are negative"};
  for (int ms = 1; ms <= 100; ++ms) report.stages.add("track", ms);
  report.stages.add("decode", 2.5);
  return report;
}

TEST(StageTimer, PercentilesAreNearestRanks) {
  StageTimer timer;
  for (int i = 0; i < 100; ++i) timer.add("pass", (i * 37) % 100 + 1);  // 1 .. 100 in another order
  const StageTimer::Summary summary = timer.summaries().at(0);
  EXPECT_EQ(summary.median_ms, 50);
  EXPECT_EQ(summary.p95_ms, 95);
}

TEST(StageTimer, OneSampleIsEveryPercentile) {
  StageTimer timer;
  timer.add("pass", 7);
  EXPECT_EQ(timer.summaries().at(0).median_ms, 7);
  EXPECT_EQ(timer.summaries().at(0).p95_ms, 7);
}

TEST(StageTimer, StagesKeepTheOrderOfTheirFirstSamples) {
  StageTimer timer;
  for (const char* stage : {"decode", "track", "decode", "encode", "track"}) timer.add(stage, 1);
  std::vector<std::string> names;
  for (const StageTimer::Summary& summary : timer.summaries()) names.push_back(summary.stage);
  EXPECT_THAT(names, ::testing::ElementsAre("decode", "track", "encode"));
}

TEST(StageTimer, MeasureGivesTheResultAndCountsAlsoWhatThrows) {
  StageTimer timer;
  EXPECT_EQ(timer.measure("work", [] { return 42; }), 42);
  EXPECT_THROW(timer.measure("failure", [] { throw std::runtime_error("no"); }), std::runtime_error);
  ASSERT_EQ(timer.summaries().size(), 2u);
  EXPECT_GE(timer.summaries()[0].median_ms, 0);
}

TEST(ReportJson, HasWhatTheDocumentationPromises) {
  const auto json = nlohmann::json::parse(report_json(example()));
  EXPECT_EQ(json.at("frames"), 36);
  EXPECT_EQ(json.at("tracked_frames"), 33);
  EXPECT_EQ(json.at("coasting_frames"), 2);
  EXPECT_EQ(json.at("lost_frames"), 1);
  EXPECT_EQ(json.at("glare").at("frames"), 12);
  EXPECT_EQ(json.at("glare").at("share"), 0.25);
  EXPECT_EQ(json.at("fps"), 4.25);
  EXPECT_EQ(json.at("renderer"), "llvmpipe");
  EXPECT_EQ(json.at("stages").at("track").at("median_ms"), 50);
  EXPECT_EQ(json.at("stages").at("track").at("p95_ms"), 95);
  EXPECT_EQ(json.at("stages").at("decode").at("median_ms"), 2.5);
  EXPECT_EQ(json.at("plan").at(1).at("choice"), "rays");
  EXPECT_EQ(json.at("plan").at(1).at("value"), "256");
  EXPECT_EQ(json.at("plan").at(1).at("reason"), "for a tolerance of 0.02");
  EXPECT_EQ(json.at("warnings"), nlohmann::json({"probe.exr: 3 texels are negative"}));
}

TEST(ReportJson, OfNothingIsStillComplete) {
  const auto json = nlohmann::json::parse(report_json({}));
  EXPECT_EQ(json.at("stages"), nlohmann::json::object());
  EXPECT_EQ(json.at("plan"), nlohmann::json::array());
  EXPECT_EQ(json.at("warnings"), nlohmann::json::array());
}

/// File names are bytes; a report about one must still be JSON.
TEST(ReportJson, SurvivesNamesThatAreNotUtf8) {
  Report report;
  report.warnings = {"caf\xe9.exr: is odd"};
  EXPECT_THAT(nlohmann::json::parse(report_json(report)).at("warnings").at(0).get<std::string>(), HasSubstr(".exr: is odd"));
}

TEST(ReportSummary, IsForPeople) {
  EXPECT_EQ(report_summary(example()), "36 frames, 33 tracked, 2 coasting, 1 lost, 4.2 frames/s on llvmpipe");
  const std::string text = report_details(example());
  EXPECT_THAT(text, HasSubstr("track"));
  EXPECT_THAT(text, HasSubstr("rays = 256: for a tolerance of 0.02"));
  EXPECT_FALSE(text.ends_with('\n'));
  EXPECT_EQ(report_details({}), "");
}

TEST(ReportSummary, OneFrameIsNotFrames) {
  Report report;
  report.frames = 1;
  EXPECT_THAT(report_summary(report), ::testing::StartsWith("1 frame, 0 tracked"));
}

TEST(WriteReport, IsReadableJson) {
  const tests::TemporaryFolder folder;
  write_report(folder.path("report.json"), example(), false);
  EXPECT_EQ(nlohmann::json::parse(tests::read_text(folder.path("report.json"))).at("frames"), 36);
}

}  // namespace
}  // namespace catchlight::app
