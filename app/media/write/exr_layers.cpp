#include "app/media/write/exr_layers.hpp"

#include <limits>

#include "app/media/read/sequence.hpp"
#include "app/media/write/output_sequence.hpp"
#include "app/support/output_file.hpp"
#include "catchlight/composite.hpp"
#include "catchlight/error.hpp"
#include "catchlight/image.hpp"
#include "catchlight/plate.hpp"
#include "render/image/image_io.hpp"

namespace catchlight::app {

namespace {

Image filled(int width, int height, int channels, float value) {
  Image image(width, height, channels);
  std::fill(image.data.begin(), image.data.end(), value);
  return image;
}

/// The layers of a frame that nothing virtual reached.
Layers untouched_layers(const Frame& frame) {
  const int width = frame.width_px(), height = frame.height_px();
  Layers layers;
  layers.plate = Image(width, height);
  layers.plate.data = linear_rgb(frame.rgb({0, 0, width, height}), frame.color());
  layers.object = filled(width, height, 4, 0.0f);
  layers.shadow = filled(width, height, 3, 1.0f);
  layers.reflection = layers.glare = layers.normal = filled(width, height, 3, 0.0f);
  layers.depth = filled(width, height, 1, std::numeric_limits<float>::infinity());
  return layers;
}

Image coverage(const Image& object) {
  Image alpha(object.width, object.height, 1);
  for (std::size_t i = 0; i < alpha.data.size(); ++i) alpha.data[i] = object.data[4 * i + 3];
  return alpha;
}

class ExrLayerOutput : public FrameOutput {
 public:
  ExrLayerOutput(SequencePattern pattern, bool overwrite) : pattern_(std::move(pattern)), overwrite_(overwrite) {}

  void write(const Frame& frame, const Composite& composite) override {
    const std::string path = pattern_.file(frame.number()).string();
    check_output_path(path, overwrite_);
    const Layers layers = composite.layers ? *composite.layers : untouched_layers(frame);
    const Image rgba = recompose(layers), matte = coverage(layers.object);
    const std::vector<std::string> rgb = {"R", "G", "B"};
    render::write_exr(path, {{"", &rgba, {"R", "G", "B", "A"}},
                             {"", &layers.depth, {"Z"}, true},
                             {"plate", &layers.plate, rgb},
                             {"object", &layers.object, {"R", "G", "B", "A"}},
                             {"shadow", &layers.shadow, rgb},
                             {"reflection", &layers.reflection, rgb},
                             {"glare", &layers.glare, rgb},
                             {"N", &layers.normal, {"X", "Y", "Z"}},
                             {"matte", &matte, {"A"}}});
  }

 private:
  SequencePattern pattern_;
  bool overwrite_;
};

}  // namespace

std::unique_ptr<FrameOutput> open_exr_layers(const std::string& pattern, const std::string& source_location,
                                             const SourceInfo& source, const SinkOptions& options) {
  const std::optional<SequencePattern> sequence = SequencePattern::parse(pattern);
  if (!sequence) throw UsageError(pattern + ": EXR layers are a file a frame; expected a number field, e.g. out.%04d.exr");
  check_output_sequence(*sequence, source_location, source, options);
  return std::make_unique<ExrLayerOutput>(*sequence, options.overwrite);
}

}  // namespace catchlight::app
