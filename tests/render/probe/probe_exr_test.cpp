// Light probes in OpenEXR files as other programs write them: windows, primaries.
#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfOutputFile.h>
#include <OpenEXR/ImfStandardAttributes.h>
#include <gmock/gmock.h>

#include "catchlight/image.hpp"
#include "render/probe/probe.hpp"
#include "tests/support/test_files.hpp"

namespace catchlight::render {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

class ExrProbe : public testing::Test {
 protected:
  /// A file that holds one colour all over its data window, as it is loaded.
  Probe loaded(Imf::Header header, const glm::vec3& value, ProbeLoadOptions options = {}) {
    const Imath::Box2i data = header.dataWindow();
    Image image(data.max.x - data.min.x + 1, data.max.y - data.min.y + 1);
    for (std::size_t i = 0; i < image.data.size(); ++i) image.data[i] = value[static_cast<int>(i % 3)];
    Imf::FrameBuffer frame;
    for (int c = 0; c < 3; ++c) {
      const std::string name(1, "RGB"[c]);
      header.channels().insert(name, Imf::Channel(Imf::FLOAT));
      const std::size_t step = 3 * sizeof(float);
      char* first = reinterpret_cast<char*>(image.data.data() + c);
      frame.insert(name, Imf::Slice::Make(Imf::FLOAT, first, data, step, step * image.width));
    }
    {
      Imf::OutputFile file((folder_ / "probe.exr").c_str(), header);
      file.setFrameBuffer(frame);
      file.writePixels(image.height);
    }
    return load_probe(folder_ / "probe.exr", options, warnings_.handler());
  }

  glm::vec3 loaded_color(const Imf::Chromaticities& primaries, const glm::vec3& value, ProbeLoadOptions options = {}) {
    Imf::Header header(32, 16);
    Imf::addChromaticities(header, primaries);
    const Probe probe = loaded(header, value, options);
    const float* rgb = probe.image.pixel(3, 3);
    return {rgb[0], rgb[1], rgb[2]};
  }

  TempFolder folder_;
  Warnings warnings_;
};

/// A compositing package writes no more than the part that holds anything, or more than what is seen.
TEST_F(ExrProbe, DisplayWindowIsThePanorama) {
  const Imath::Box2i display({10, 20}, {41, 35});
  const Probe upper = loaded(Imf::Header(display, {{10, 20}, {41, 27}}), glm::vec3(1));
  EXPECT_EQ(upper.layout, ProbeLayout::latlong);
  ASSERT_EQ(upper.image.height, 16);
  for (int y = 0; y < 16; ++y) EXPECT_EQ(upper.image.pixel(5, y)[0], y < 8 ? 1 : 0) << y;
  EXPECT_THAT(warnings_.all, ElementsAre(HasSubstr("holds 32 x 8 texels of the panorama's 32 x 16; the rest is black")));
  warnings_.all.clear();
  const Probe overscan = loaded(Imf::Header(display, {{6, 16}, {45, 39}}), glm::vec3(1));
  EXPECT_EQ(overscan.image.width, 32);
  EXPECT_EQ(overscan.image.height, 16);
  EXPECT_THAT(warnings_.all, IsEmpty());
}

/// ImfEnvmap.h: an environment map is the data window.
TEST_F(ExrProbe, DataWindowIsThePanoramaWhereTheFileSaysThatItIsOne) {
  Imf::Header header(Imath::Box2i({0, 0}, {63, 31}), Imath::Box2i({8, 8}, {23, 15}));
  Imf::addEnvmap(header, Imf::ENVMAP_LATLONG);
  EXPECT_EQ(loaded(header, glm::vec3(1)).image.width, 16);
}

/// The primaries of XYZ themselves have y = 0. Their white becomes that of Rec. 709.
TEST_F(ExrProbe, PrimariesOfXyzAreRead) {
  const Imf::Chromaticities xyz({1, 0}, {0, 1}, {0, 0}, {1 / 3.0f, 1 / 3.0f});
  const glm::vec3 white = loaded_color(xyz, glm::vec3(1));
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(white[c], 1, 1e-4);
  EXPECT_THAT(warnings_.all, IsEmpty());
}

TEST_F(ExrProbe, PrimariesThatSpanNothingAreWarnedOf) {
  const glm::vec3 value(0.2f, 0.4f, 0.6f), same = loaded_color(Imf::Chromaticities({0, 0}, {0, 0}, {0, 0}, {0, 0}), value);
  EXPECT_EQ(same, value);
  EXPECT_THAT(warnings_.all, ElementsAre(HasSubstr("its chromaticities span no colours; the values are taken as Rec. 709")));
}

/// The green of ACES lies far beyond that of Rec. 709, whose red would have to be negative.
TEST_F(ExrProbe, ColoursBeyondRec709AreNoDamage) {
  const Imf::Chromaticities aces({0.7347f, 0.2653f}, {0, 1}, {0.0001f, -0.077f}, {0.32168f, 0.33767f});
  const glm::vec3 green = loaded_color(aces, {0, 1, 0}, {{}, true});
  EXPECT_EQ(green.r, 0);
  EXPECT_GT(green.g, 1);
}

}  // namespace
}  // namespace catchlight::render
