#include <CLI/CLI.hpp>
#include <cmath>
#include <memory>

#include "app/commands/help.hpp"
#include "app/commands/probe.hpp"
#include "app/settings/scene_file.hpp"
#include "app/support/output_file.hpp"
#include "app/tools/probe_merge/merge.hpp"
#include "app/tools/probe_merge/photographs.hpp"
#include "app/tools/tag_print/tag_grid.hpp"
#include "catchlight/error.hpp"
#include "catchlight/tag.hpp"
#include "catchlight/util/enum_names.hpp"
#include "catchlight/util/text.hpp"

namespace catchlight::app {
namespace {

struct Options {
  MergeRequest request;
  std::vector<std::string> first_view, balls;
  std::string output, times, layout = "latlong", reflectance, scene, up;
  PrintedTag tag;
  bool overwrite = false;
};

std::vector<double> numbers(const std::string& text, std::size_t count, const char* option, const char* expected) {
  std::vector<double> values;
  for (const std::string& field : split(text, ','))
    if (const auto value = real_from_text(field); value && std::isfinite(*value)) values.push_back(*value);
  if (values.size() != count || split(text, ',').size() != count)
    throw UsageError(std::string(option) + " is \"" + text + "\"; expected " + expected);
  return values;
}

glm::dvec3 reflectance_of(const std::string& text) {
  if (text.empty()) return glm::dvec3(1);
  const bool is_one = text.find(',') == std::string::npos;
  const auto values = numbers(text, is_one ? 1 : 3, "--ball-reflectance", "a share such as 0.6, or R,G,B");
  const glm::dvec3 share = is_one ? glm::dvec3(values[0]) : glm::dvec3(values[0], values[1], values[2]);
  for (int c = 0; c < 3; ++c)
    if (!(share[c] > 0 && share[c] <= 1))
      throw UsageError("--ball-reflectance is " + text + "; expected shares above 0, at most 1");
  return share;
}

void read_tag(Options& options, bool is_tag_given) {
  MergeRequest& request = options.request;
  if (!options.scene.empty()) {
    const SceneSettings scene = read_scene_file(options.scene);
    request.tag = scene.tag.target();
    request.up = scene.probe.up;
    request.yaw_deg = scene.probe.yaw_deg;
  } else if (is_tag_given) {
    check_length(options.tag.size_m, "--tag-size-m");
    request.tag = TagTarget{options.tag, {}};
  }
  if (const auto up = value_named<render::UpAxis>(options.up)) request.up = *up;
}

void merge(Options& options, bool is_tag_given, Log& log) {
  if (!options.output.ends_with(".exr") && !options.output.ends_with(".hdr"))
    throw UsageError(options.output + ": expected a name that ends in .exr or .hdr");
  PendingFile output = pending_output(options.output, options.overwrite);
  MergeRequest& request = options.request;
  if (!options.first_view.empty()) request.views.insert(request.views.begin(), options.first_view);
  if (!options.times.empty()) request.times_s = exposure_times_from_text(options.times);
  for (const std::string& text : options.balls) {
    const auto ball = numbers(text, 3, "--ball", "X,Y,RADIUS in pixels");
    request.balls.push_back({{ball[0], ball[1]}, ball[2]});
  }
  request.reflectance = reflectance_of(options.reflectance);
  request.layout = render::probe_layout_from_name(options.layout);
  read_tag(options, is_tag_given);
  std::vector<std::string> inputs{options.scene, request.camera_file.value_or("")};
  for (const std::vector<std::string>& view : request.views) inputs.insert(inputs.end(), view.begin(), view.end());
  refuse_shared_files({options.output}, inputs);
  render::save_probe(output.pending_path(), merge_probe(request, log));
  output.commit();
}

void add_views(CLI::App& command, Options& options) {
  command.add_option("PHOTO", options.first_view, "the photographs of one camera position, in any order");
  command.add_option("--view", options.request.views, "those of a further camera position; once for each")->inject_separator();
  command.add_option("--times", options.times, "exposure times in seconds, such as 1/1000,1/60,1; where left out, EXIF says");
  command
      .add_option("--response", options.request.response,
                  "of the camera; auto: recover from 3 photographs of 8 bits on, else srgb")
      ->check(CLI::IsMember({"auto", "recover", "srgb", "linear"}))
      ->capture_default_str();
  command.add_option("--ball", options.balls, "X,Y,RADIUS of the ball in pixels, once for each view; found where left out")
      ->allow_extra_args(false);
  command.add_option("--ball-reflectance", options.reflectance,
                     "share of light the ball reflects, one number or R,G,B (default 1)");
  command.add_option("--camera", options.request.camera_file, "camera file of the photographs; without, the camera is far away")
      ->excludes(command.add_option("--fov", options.request.fov_deg, "horizontal field of view in degrees, instead of --camera")
                     ->check(CLI::Range(1.0, 170.0)));
}

CLI::Option* add_orientation(CLI::App& command, Options& options) {
  command.add_option("--scene", options.scene, "scene file: its tag beside the ball, and how the probe stands on it");
  CLI::Option* size =
      command.add_option("--tag-size-m", options.tag.size_m, "instead of --scene: side of the tag beside the ball");
  command.add_option("--tag-family", options.tag.family, "its family")->capture_default_str();
  command.add_option("--tag-id", options.tag.id, "its id")->capture_default_str();
  command.add_option("--up", options.up, "the tag's axis that points up: z on a table, y on a wall (default z)")
      ->check(CLI::IsMember(name_list<render::UpAxis>()));
  command
      .add_option("--view-yaw", options.request.view_yaw_deg,
                  "without a tag: where each camera stands, degrees about up; 0 is probe +z, 90 is +x")
      ->delimiter(',')
      ->allow_extra_args(false);
  command.add_option("--view-pitch", options.request.view_pitch_deg, "without a tag: how far each camera looks down, degrees")
      ->delimiter(',')
      ->allow_extra_args(false);
  return size;
}

}  // namespace

void add_probe_merge(CLI::App& parent, Context& context) {
  CLI::App& command = *parent.add_subcommand("merge", "Makes a probe of photographs of a mirror ball");
  const auto options = std::make_shared<Options>();
  command.footer("docs/probes.md says how to take the photographs.");
  add_views(command, *options);
  CLI::Option* tag_size = add_orientation(command, *options);
  command.add_option("-o,--output", options->output, "OpenEXR or Radiance HDR, by extension")->required();
  command.add_option("--layout", options->layout, quoted_list(name_list<render::ProbeLayout>()))->capture_default_str();
  command.add_option("--width", options->request.width_px, "in texels; 0: as fine as the ball")->check(CLI::Range(0, 16384));
  command
      .add_option("--photographer-deg", options->request.photographer_deg,
                  "half-angle around the camera that other views replace")
      ->check(CLI::Range(1.0, 60.0))
      ->capture_default_str();
  command.add_flag("-y,--overwrite", options->overwrite, "replace an existing output");
  show_examples(command, {"catchlight probe merge ball-*.jpg --scene scene.toml --camera camera.yaml -o room.exr",
                          "catchlight probe merge a1.jpg a2.jpg a3.jpg --view b1.jpg b2.jpg b3.jpg --view-yaw 0,90 -o room.exr"});
  command.callback([options, tag_size, &context] { merge(*options, tag_size->count() > 0, context.log); });
}

}  // namespace catchlight::app
