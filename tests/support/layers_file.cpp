#include "tests/support/layers_file.hpp"

#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfInputFile.h>
#include <OpenEXR/ImfStandardAttributes.h>
#include <OpenEXR/ImfStringAttribute.h>

#include <cstdio>
#include <stdexcept>
#include <vector>

namespace catchlight::tests {
namespace {

Image read_channels(Imf::InputFile& file, const std::vector<std::string>& names) {
  const Imath::Box2i window = file.header().dataWindow();
  Image image(window.max.x + 1, window.max.y + 1, static_cast<int>(names.size()));
  Imf::FrameBuffer frame;
  for (std::size_t c = 0; c < names.size(); ++c) {
    if (!file.header().channels().findChannel(names[c])) throw std::runtime_error("no channel " + names[c]);
    const std::size_t pixel_bytes = sizeof(float) * names.size();
    char* first = reinterpret_cast<char*>(image.data.data() + c);
    frame.insert(names[c], Imf::Slice::Make(Imf::FLOAT, first, window, pixel_bytes, pixel_bytes * image.width));
  }
  file.setFrameBuffer(frame);
  file.readPixels(window.min.y, window.max.y);
  return image;
}

glm::dmat4 column_vector_matrix(const Imath::M44f& matrix) {
  glm::dmat4 result;
  for (int i = 0; i < 4; ++i)
    for (int j = 0; j < 4; ++j) result[i][j] = matrix[i][j];
  return result;
}

}  // namespace

Image read_channels(const std::string& path, const std::vector<std::string>& names) {
  Imf::InputFile file(path.c_str());
  return read_channels(file, names);
}

render::ExrAttributes read_attributes(const std::string& path) {
  const Imf::InputFile file(path.c_str());
  const Imf::Header& header = file.header();
  render::ExrAttributes attributes;
  if (const auto* software = header.findTypedAttribute<Imf::StringAttribute>("software")) attributes.software = software->value();
  if (Imf::hasFramesPerSecond(header)) attributes.frames_per_second = static_cast<double>(Imf::framesPerSecond(header));
  if (Imf::hasTimeCode(header)) {
    const Imf::TimeCode& code = Imf::timeCode(header);
    char text[32];
    std::snprintf(text, sizeof text, "%02d:%02d:%02d%c%02d", code.hours(), code.minutes(), code.seconds(),
                  code.dropFrame() ? ';' : ':', code.frame());
    attributes.time_code = text;
  }
  if (Imf::hasWorldToCamera(header)) attributes.camera_from_world = column_vector_matrix(Imf::worldToCamera(header));
  if (Imf::hasWorldToNDC(header)) attributes.clip_from_world = column_vector_matrix(Imf::worldToNDC(header));
  return attributes;
}

LayersFile read_layers(const std::string& path) {
  Imf::InputFile file(path.c_str());
  const auto read = [&](const std::string& layer, const std::vector<std::string>& channels) {
    std::vector<std::string> names;
    for (const std::string& channel : channels) names.push_back(layer + channel);
    return read_channels(file, names);
  };
  const std::vector<std::string> rgb = {"R", "G", "B"}, rgba = {"R", "G", "B", "A"};
  return {{.plate = read("plate.", rgb),
           .object = read("object.", rgba),
           .shadow = read("shadow.", rgb),
           .reflection = read("reflection.", rgb),
           .glare = read("glare.", rgb),
           .normal = read("N.", {"X", "Y", "Z"}),
           .depth = read("", {"Z"})},
          read("", rgba),
          read("matte.", {"A"})};
}

}  // namespace catchlight::tests
