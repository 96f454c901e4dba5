#include "app/media/write/frame_output.hpp"

#include <filesystem>

#include "app/media/write/exr_layers.hpp"
#include "catchlight/error.hpp"

namespace catchlight::app {

namespace {

class MediaOutput : public FrameOutput {
 public:
  explicit MediaOutput(std::unique_ptr<MediaSink> sink) : sink_(std::move(sink)) {}

  void write(const Frame& plate, const Composite& composite, const std::optional<RigidTransform>&) override {
    sink_->write(composite.rgba.empty() ? plate : plate.with_composite(composite));
  }
  void finish() override { sink_->finish(); }

 private:
  std::unique_ptr<MediaSink> sink_;
};

}  // namespace

bool holds_layers(const std::string& path) {
  return std::filesystem::path(path).extension() == ".exr";
}

std::unique_ptr<FrameOutput> open_output(const std::string& path, const std::string& source_location, const MediaSource& source,
                                         const SinkOptions& options, const LayerOptions& layers) {
  if (holds_layers(path) && !options.pixel_format.empty())
    throw UsageError("--pixel-format: " + path + " is layers, which hold half floats; leave it out");
  if (holds_layers(path)) return open_exr_layers(path, source_location, source.info(), options, layers);
  if (layers.style != LayerStyle::plain)
    throw UsageError("--layers-for: " + path + " is no layers; leave it out, or write a sequence such as out.%04d.exr");
  return std::make_unique<MediaOutput>(MediaSink::open(path, source_location, source, options));
}

}  // namespace catchlight::app
