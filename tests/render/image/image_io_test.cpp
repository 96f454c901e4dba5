#include "render/image/image_io.hpp"
#include "catchlight/error.hpp"
#include "catchlight/image.hpp"
#include "tests/support/test_files.hpp"

#include <gmock/gmock.h>
#include <array>

#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfInputFile.h>
#include <OpenEXR/ImfOutputFile.h>
#include <OpenEXR/ImfStandardAttributes.h>

#include <cmath>
#include <functional>
#include <opencv2/imgcodecs.hpp>
#include <thread>

namespace catchlight::render {
namespace {

Image ramp(int width, int height, int channels = 3) {
  Image image(width, height, channels);
  for (std::size_t i = 0; i < image.data.size(); ++i) image.data[i] = static_cast<float>(i) / 8;  // exact in half up to 256
  return image;
}

std::vector<std::string> names_in(const std::string& folder) {
  std::vector<std::string> names;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) names.push_back(entry.path().filename());
  return names;
}

/// Lets two threads write pictures of another size and colour under one name, again and again.
void expect_one_whole_file(const std::function<void(const Image&)>& write, const std::function<Image()>& read) {
  const auto write_often = [&](int size, float value) {
    Image image(size, size);
    std::fill(image.data.begin(), image.data.end(), value);
    for (int i = 0; i < 40; ++i) EXPECT_EQ(error_of([&] { write(image); }), "");
  };
  std::thread other([&] { write_often(150, 2.0f); });
  write_often(100, 1.0f);
  other.join();
  const Image image = read();
  EXPECT_THAT(image.data, testing::Each(image.width == 100 ? 1.0f : 2.0f));
}

// Writes with OpenEXR alone: any channels, windows and primaries.
void write_foreign_exr(const std::string& path, Imf::Header header, const std::vector<std::string>& channels, float value) {
  const Imath::Box2i window = header.dataWindow();
  const int width = window.max.x - window.min.x + 1, height = window.max.y - window.min.y + 1;
  std::vector<float> data(static_cast<std::size_t>(width) * height);
  for (std::size_t i = 0; i < data.size(); ++i) data[i] = value + static_cast<float>(i);
  Imf::FrameBuffer frame;
  for (const std::string& name : channels) {
    header.channels().insert(name, Imf::Channel(Imf::FLOAT));
    frame.insert(name, Imf::Slice::Make(Imf::FLOAT, data.data(), window));
  }
  Imf::OutputFile file(path.c_str(), header);
  file.setFrameBuffer(frame);
  file.writePixels(height);
}

TEST(ExrFile, RoundTripsFloats) {
  const TempFolder folder;
  Image image = ramp(7, 5);
  image.data[4] = 123456.789f;
  write_exr(folder / "a.exr", {{"", &image, {"R", "G", "B"}, true}}, ExrEnvmap::latlong);
  const ExrPicture read = read_exr_picture(folder / "a.exr");
  EXPECT_EQ(read.image.data, image.data);
  EXPECT_EQ(read.envmap, ExrEnvmap::latlong);
}

TEST(ExrFile, HalfHoldsItsLargestValueInsteadOfInfinity) {
  const TempFolder folder;
  Image image(2, 1);
  image.data = {1e6f, -1e6f, 0.5f, 0, 1, 2};
  write_exr(folder / "a.exr", {{"", &image, {"R", "G", "B"}}});
  EXPECT_EQ(read_exr(folder / "a.exr").data, (RawVector<float>{65504, -65504, 0.5f, 0, 1, 2}));
}

TEST(ExrFile, KeepsLayersApartWithTheirTypes) {
  const TempFolder folder;
  const Image beauty = ramp(4, 3, 4), shadow = ramp(4, 3), depth = ramp(4, 3, 1);
  write_exr(folder / "a.exr",
            {{"", &beauty, {"R", "G", "B", "A"}}, {"shadow", &shadow, {"R", "G", "B"}}, {"", &depth, {"Z"}, true}});
  Imf::InputFile file((folder / "a.exr").c_str());
  const Imf::ChannelList& channels = file.header().channels();
  for (const char* name : {"R", "G", "B", "A", "shadow.R", "shadow.G", "shadow.B"}) {
    ASSERT_TRUE(channels.findChannel(name)) << name;
    EXPECT_EQ(channels[name].type, Imf::HALF) << name;
  }
  EXPECT_EQ(channels["Z"].type, Imf::FLOAT);
  EXPECT_TRUE(Imf::hasChromaticities(file.header()));
  EXPECT_EQ(read_exr(folder / "a.exr").data, beauty.data);
  RawVector<float> read_depth(12);
  Imf::FrameBuffer frame;
  frame.insert("Z", Imf::Slice::Make(Imf::FLOAT, read_depth.data(), file.header().dataWindow()));
  file.setFrameBuffer(frame);
  file.readPixels(0, 2);
  EXPECT_EQ(read_depth, depth.data);
}

TEST(ExrFile, LeavesNothingBehindWhereItCannotBeWritten) {
  const Image image = ramp(2, 2);
  const TempFolder folder;
  const std::string error = error_of([&] { write_exr(folder / "no/such/folder.exr", {{"", &image, {"R", "G", "B"}}}); });
  EXPECT_NE(error.find("no/such/folder.exr"), std::string::npos) << error;
  std::filesystem::create_directories(folder / "taken.exr/inside");
  EXPECT_THROW(write_exr(folder / "taken.exr", {{"", &image, {"R", "G", "B"}}}), Error);
  EXPECT_FALSE(std::filesystem::exists(folder / "taken.exr.partial"));
  EXPECT_THAT(names_in(folder / ""), testing::ElementsAre("taken.exr"));
}

TEST(ExrFile, TwoWritersOfOneFileLeaveOneWholeFile) {
  const TempFolder folder;
  const auto write = [&](const Image& image) { write_exr(folder / "a.exr", {{"", &image, {"R", "G", "B"}}}); };
  expect_one_whole_file(write, [&] { return read_exr(folder / "a.exr"); });
  EXPECT_THAT(names_in(folder / ""), testing::ElementsAre("a.exr"));
}

TEST(ExrFile, ReadsADataWindowThatStartsAnywhere) {
  const TempFolder folder;
  const Imf::Header header(Imath::Box2i({0, 0}, {99, 99}), Imath::Box2i({-3, 10}, {0, 11}));
  write_foreign_exr(folder / "a.exr", header, {"R", "G", "B"}, 0);
  const Image image = read_exr(folder / "a.exr");
  ASSERT_EQ(image.width, 4);
  ASSERT_EQ(image.height, 2);
  for (int i = 0; i < 8; ++i) EXPECT_EQ(image.data[3 * i + 1], static_cast<float>(i));
}

TEST(ExrFile, ReadsLuminanceAsGrey) {
  const TempFolder folder;
  write_foreign_exr(folder / "a.exr", Imf::Header(3, 2), {"Y"}, 1);
  const Image image = read_exr(folder / "a.exr");
  EXPECT_EQ(image.data, (RawVector<float>{1, 1, 1, 2, 2, 2, 3, 3, 3, 4, 4, 4, 5, 5, 5, 6, 6, 6}));
}

TEST(ExrFile, ConvertsOtherPrimariesAndKeepsWhiteWhite) {
  const TempFolder folder;
  Imf::Header header(1, 1);  // ACES AP0: another white point
  Imf::addChromaticities(header, Imf::Chromaticities({0.7347f, 0.2653f}, {0.0f, 1.0f}, {0.0001f, -0.077f}, {0.32168f, 0.33767f}));
  write_foreign_exr(folder / "white.exr", header, {"R", "G", "B"}, 2);
  const Image white = read_exr(folder / "white.exr");
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(white.data[c], 2, 2e-3);
}

TEST(ExrFile, ConvertsRec2020RedAsTheStandardSays) {
  const TempFolder folder;
  Imf::Header header(1, 1);
  Imf::addChromaticities(header, Imf::Chromaticities({0.708f, 0.292f}, {0.17f, 0.797f}, {0.131f, 0.046f}, {0.3127f, 0.329f}));
  std::vector<float> one{1}, zero{0};
  Imf::FrameBuffer frame;
  for (const char* name : {"R", "G", "B"}) {
    header.channels().insert(name, Imf::Channel(Imf::FLOAT));
    frame.insert(name, Imf::Slice::Make(Imf::FLOAT, *name == 'R' ? one.data() : zero.data(), header.dataWindow()));
  }
  {
    Imf::OutputFile file((folder / "a.exr").c_str(), header);
    file.setFrameBuffer(frame);
    file.writePixels(1);
  }
  const Image image = read_exr(folder / "a.exr");  // ITU-R BT.2087
  EXPECT_NEAR(image.data[0], 1.6605, 1e-3);
  EXPECT_NEAR(image.data[1], -0.1246, 1e-3);
  EXPECT_NEAR(image.data[2], -0.0182, 1e-3);
}

TEST(ExrFile, NamesTheChannelsItCannotUse) {
  const TempFolder folder;
  write_foreign_exr(folder / "a.exr", Imf::Header(2, 2), {"beauty.R", "Z"}, 0);
  const std::string error = error_of([&] { read_exr(folder / "a.exr"); });
  EXPECT_NE(error.find("Z, beauty.R"), std::string::npos) << error;
}

TEST(ExrFile, TruncatedOrForeignFilesAreNamed) {
  const TempFolder folder;
  const Image image = ramp(64, 64);
  write_exr(folder / "a.exr", {{"", &image, {"R", "G", "B"}}});
  const std::string bytes = read_text(folder / "a.exr");
  for (const std::size_t size : {bytes.size() / 2, std::size_t{100}, std::size_t{5}, std::size_t{0}}) {
    write_text(folder / "b.exr", bytes.substr(0, size));
    const std::string error = error_of([&] { read_exr(folder / "b.exr"); });
    EXPECT_NE(error.find("b.exr"), std::string::npos) << size << " bytes: " << error;
  }
  write_text(folder / "b.exr", bytes.substr(0, bytes.size() - 100));
  EXPECT_NE(error_of([&] { read_exr(folder / "b.exr"); }).find("b.exr: is cut short"), std::string::npos) << "in our words";
  EXPECT_NE(error_of([&] { read_exr(folder / "none.exr"); }).find("none.exr: no such file"), std::string::npos);
}

TEST(HdrFile, RoundTripsWithinItsPrecision) {
  const TempFolder folder;
  for (const int width : {1, 7, 8, 200, 300}) {  // flat and run-length scanlines, runs over 128
    Image image(width, 3);
    for (std::size_t i = 0; i < image.data.size(); ++i) image.data[i] = std::pow(1.7f, static_cast<float>(i % 60) - 20);
    write_hdr(folder / "a.hdr", image);
    const Image read = read_hdr(folder / "a.hdr");
    ASSERT_EQ(read.width, width);
    for (int i = 0; i < width * 3; ++i) {
      const float brightest = std::max({image.data[3 * i], image.data[3 * i + 1], image.data[3 * i + 2]});
      for (int c = 0; c < 3; ++c) EXPECT_NEAR(read.data[3 * i + c], image.data[3 * i + c], brightest / 128);
    }
  }
}

TEST(HdrFile, TwoWritersOfOneFileLeaveOneWholeFile) {
  const TempFolder folder;
  expect_one_whole_file([&](const Image& image) { write_hdr(folder / "a.hdr", image); },
                        [&] { return read_hdr(folder / "a.hdr"); });
  EXPECT_THAT(names_in(folder / ""), testing::ElementsAre("a.hdr"));
}

TEST(HdrFile, BlackNegativeAndHugeValuesAreSane) {
  const TempFolder folder;
  Image image(3, 1);
  image.data = {0, 0, 0, -1, 2, -3, 3e38f, 1, 1};
  write_hdr(folder / "a.hdr", image);
  const Image read = read_hdr(folder / "a.hdr");
  for (int i : {0, 1, 2, 3, 5}) EXPECT_EQ(read.data[i], 0) << i;
  EXPECT_NEAR(read.data[4], 2, 0.02);
  EXPECT_TRUE(std::isfinite(read.data[6]));
  EXPECT_GT(read.data[6], 9e37f);
}

TEST(HdrFile, AgreesWithOpenCv) {
  const TempFolder folder;
  Image image(40, 20);
  for (std::size_t i = 0; i < image.data.size(); ++i) image.data[i] = 0.01f * static_cast<float>(1 + i * 37 % 1009);
  write_hdr(folder / "ours.hdr", image);
  const Image read = read_hdr(folder / "ours.hdr");
  const cv::Mat theirs = cv::imread(folder / "ours.hdr", cv::IMREAD_UNCHANGED);
  ASSERT_EQ(theirs.cols, 40);
  for (int y = 0; y < 20; ++y) {
    for (int x = 0; x < 40; ++x) {
      for (int c = 0; c < 3; ++c) EXPECT_EQ(read.pixel(x, y)[c], theirs.at<cv::Vec3f>(y, x)[2 - c]);
    }
  }
  cv::imwrite(folder / "theirs.hdr", theirs);  // run lengths, which ours never writes
  EXPECT_EQ(read_hdr(folder / "theirs.hdr").data, read.data);
}

std::string flat_hdr(const std::string& resolution, const std::string& header = "") {
  // Two texels: (1, 2, 3)/256 * 2 and (4, 5, 6)/256 * 2.
  return "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n" + header + "\n" + resolution + "\n" + "\x01\x02\x03\x81\x04\x05\x06\x81";
}

TEST(HdrFile, HonoursOrientationAndExposure) {
  const TempFolder folder;
  const auto first_red = [&](const std::string& text) {
    write_text(folder / "a.hdr", text);
    const Image image = read_hdr(folder / "a.hdr");
    return std::array<float, 3>{static_cast<float>(image.width), image.pixel(0, 0)[0] * 128, image.data[3] * 128};
  };
  using Found = std::array<float, 3>;  // width, first and second red
  EXPECT_EQ(first_red(flat_hdr("-Y 1 +X 2")), (Found{2, 1, 4}));
  EXPECT_EQ(first_red(flat_hdr("-Y 1 -X 2")), (Found{2, 4, 1}));
  EXPECT_EQ(first_red(flat_hdr("-Y 2 +X 1")), (Found{1, 1, 4}));
  EXPECT_EQ(first_red(flat_hdr("+Y 2 +X 1")), (Found{1, 4, 1}));
  EXPECT_EQ(first_red(flat_hdr("+X 2 -Y 1")), (Found{2, 1, 4}));
  EXPECT_EQ(first_red(flat_hdr("+X 1 +Y 2")), (Found{1, 4, 1}));
  EXPECT_EQ(first_red(flat_hdr("-Y 1 +X 2", "EXPOSURE=2\nEXPOSURE=0.25\n")), (Found{2, 2, 8}));
}

TEST(HdrFile, ReadsTheOldRepeats) {
  const TempFolder folder;
  write_text(folder / "a.hdr", std::string("#?RGBE\n\n-Y 1 +X 4\n") + "\x09\x02\x03\x81" + std::string("\x01\x01\x01\x03", 4));
  EXPECT_EQ(read_hdr(folder / "a.hdr").pixel(3, 0)[0], 9 / 128.0f);
}

TEST(HdrFile, DamagedFilesAreNamed) {
  const TempFolder folder;
  const std::string good = flat_hdr("-Y 1 +X 2");
  const std::string bad[] = {"",
                             "P6 not this",
                             "#?RADIANCE\n",
                             flat_hdr("-Y 0 +X 2"),
                             flat_hdr("-Y 1 +Y 2"),
                             flat_hdr("-Y 99999999 +X 99999999"),
                             flat_hdr("two by two"),
                             flat_hdr("-Y 1 +X 2", "EXPOSURE=0\n"),
                             flat_hdr("-Y 1 +X 2", "FORMAT=32-bit_rle_xyze\n"),
                             good.substr(0, good.size() - 1),
                             std::string("#?RADIANCE\n\n-Y 1 +X 9\n\x02\x02\x00\x09\xff\x01", 29),
                             std::string("#?RADIANCE\n\n-Y 1 +X 9\n\x02\x02\x00\x08\x01\x01", 29),
                             std::string("#?RADIANCE\n\n-Y 1 +X 2\n\x01\x01\x01\x01\x01\x01\x01\x01", 30)};
  for (const std::string& text : bad) {
    write_text(folder / "bad.hdr", text);
    const std::string error = error_of([&] { read_hdr(folder / "bad.hdr"); });
    EXPECT_NE(error.find("bad.hdr"), std::string::npos) << text << " -> " << error;
  }
}

}  // namespace
}  // namespace catchlight::render
