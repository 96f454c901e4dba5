#include "tests/support/layers_file.hpp"

#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfInputFile.h>

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

}  // namespace

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
