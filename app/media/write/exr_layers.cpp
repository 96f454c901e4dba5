#include "app/media/write/exr_layers.hpp"

#include "app/media/pixels/untouched_layers.hpp"
#include "app/media/read/sequence.hpp"
#include "app/media/write/output_sequence.hpp"
#include "app/media/write/timecode.hpp"
#include "app/support/output_file.hpp"
#include "catchlight/composite.hpp"
#include "catchlight/error.hpp"
#include "catchlight/image.hpp"
#include "render/image/image_io.hpp"

namespace catchlight::app {

namespace {

Image coverage(const Image& object) {
  Image alpha(object.width, object.height, 1);
  for (std::size_t i = 0; i < alpha.data.size(); ++i) alpha.data[i] = object.data[4 * i + 3];
  return alpha;
}

/// World: the tag's, +y up. The picture's edges are the clip space's.
void add_camera(const CameraModel& camera, const glm::dmat3& world_from_tag, const RigidTransform& camera_from_tag,
                render::ExrAttributes& to) {
  const glm::dmat3 y_up(glm::dvec3(1, 0, 0), glm::dvec3(0, -1, 0), glm::dvec3(0, 0, -1));
  glm::dmat4 camera_from_world(y_up * camera_from_tag.rotation * glm::transpose(world_from_tag));
  camera_from_world[3] = glm::dvec4(y_up * camera_from_tag.translation_m, 1);
  constexpr double kNear_m = 0.01, kFar_m = 1000;
  glm::dmat4 clip_from_camera(0.0);
  clip_from_camera[0][0] = 2 * camera.fx_px / camera.width_px;
  clip_from_camera[1][1] = 2 * camera.fy_px / camera.height_px;
  clip_from_camera[2] = {1 - 2 * (camera.cx_px + 0.5) / camera.width_px, 2 * (camera.cy_px + 0.5) / camera.height_px - 1,
                         (kFar_m + kNear_m) / (kNear_m - kFar_m), -1};
  clip_from_camera[3][2] = 2 * kFar_m * kNear_m / (kNear_m - kFar_m);
  to.camera_from_world = camera_from_world;
  to.clip_from_world = clip_from_camera * camera_from_world;
}

class ExrLayerOutput : public FrameOutput {
 public:
  ExrLayerOutput(SequencePattern pattern, const SourceInfo& source, bool overwrite, LayerOptions options)
      : pattern_(std::move(pattern)), source_(source), overwrite_(overwrite), options_(std::move(options)) {}

  void write(const Frame& frame, const Composite& composite, const std::optional<RigidTransform>& pose) override {
    Shown shown{frame, composite.layers, pose};
    if (options_.style == LayerStyle::plain) return put(shown, {});
    if (waiting_) put(*waiting_, pose);
    if (waiting_) pose_before_ = waiting_->camera_from_tag;
    waiting_ = std::move(shown);
  }

  void finish() override {
    if (waiting_) put(*waiting_, {});
  }

 private:
  struct Shown {
    Frame frame;
    std::optional<Layers> layers;
    std::optional<RigidTransform> camera_from_tag;
  };

  /// Offsets to a frame without a pose are 0.
  std::vector<MotionLayer> motion(const Shown& shown, const Image& depth, const std::optional<RigidTransform>& pose_after) const {
    if (options_.style == LayerStyle::plain) return {};
    const auto to = [&](const std::optional<RigidTransform>& other) {
      if (!shown.camera_from_tag || !other) return Image(depth.width, depth.height, 2);
      return offset_px(depth, options_.camera, *shown.camera_from_tag, *other);
    };
    return motion_layers(options_.style, to(pose_before_), to(pose_after));
  }

  render::ExrAttributes attributes(const Shown& shown) const {
    render::ExrAttributes attributes{.software = options_.software, .frames_per_second = source_.frame_rate};
    attributes.time_code = timecode_at(source_, shown.frame.number());
    if (shown.camera_from_tag) add_camera(options_.camera, options_.world_from_tag, *shown.camera_from_tag, attributes);
    return attributes;
  }

  void put(const Shown& shown, const std::optional<RigidTransform>& pose_after) {
    const std::string path = pattern_.file(shown.frame.number()).string();
    check_output_path(path, overwrite_);
    const Layers layers = shown.layers ? *shown.layers : untouched_layers(shown.frame);
    const Image rgba = recompose(layers), matte = coverage(layers.object);
    const Image normal = shown.camera_from_tag ? styled_normals(layers.normal, options_, *shown.camera_from_tag) : layers.normal;
    const std::vector<MotionLayer> moved = motion(shown, layers.depth, pose_after);
    const std::vector<std::string> rgb = {"R", "G", "B"};
    std::vector<render::ExrLayer> all = {{"", &rgba, {"R", "G", "B", "A"}}, {"", &layers.depth, {"Z"}, true},
                                         {"plate", &layers.plate, rgb},     {"object", &layers.object, {"R", "G", "B", "A"}},
                                         {"shadow", &layers.shadow, rgb},   {"reflection", &layers.reflection, rgb},
                                         {"glare", &layers.glare, rgb},     {"N", &normal, {"X", "Y", "Z"}},
                                         {"matte", &matte, {"A"}}};
    for (const MotionLayer& layer : moved) all.push_back({layer.name, &layer.image, layer.channels, true});
    render::write_exr(path, all, {}, attributes(shown));
  }

  SequencePattern pattern_;
  SourceInfo source_;
  bool overwrite_;
  LayerOptions options_;
  std::optional<Shown> waiting_;  ///< for the next frame's pose, where motion is written
  std::optional<RigidTransform> pose_before_;
};

}  // namespace

std::unique_ptr<FrameOutput> open_exr_layers(const std::string& pattern, const std::string& source_location,
                                             const SourceInfo& source, const SinkOptions& options, const LayerOptions& layers) {
  const std::optional<SequencePattern> sequence = SequencePattern::parse(pattern);
  if (!sequence) throw UsageError(pattern + ": EXR layers are a file a frame; expected a number field, e.g. out.%04d.exr");
  check_output_sequence(*sequence, source_location, source, options);
  return std::make_unique<ExrLayerOutput>(*sequence, source, options.overwrite, layers);
}

}  // namespace catchlight::app
