#include <CLI/CLI.hpp>
#include <cmath>
#include <cstdio>
#include <glm/gtc/constants.hpp>
#include <memory>
#include <opencv2/core.hpp>
#include <optional>

#include "app/commands/help.hpp"
#include "app/commands/probe.hpp"
#include "app/settings/scene_settings.hpp"
#include "app/support/output_file.hpp"
#include "app/tools/probe_view/mirror_ball.hpp"
#include "app/tools/probe_view/probe_preview.hpp"
#include "app/tools/probe_view/probe_statistics.hpp"
#include "catchlight/color.hpp"
#include "catchlight/error.hpp"
#include "catchlight/image.hpp"
#include "catchlight/util/enum_names.hpp"
#include "catchlight/util/text.hpp"
#include "render/image/picture_file.hpp"
#include "render/made_probe/made_probe.hpp"
#include "render/probe/probe_split.hpp"
#include "render/render_scene.hpp"

namespace catchlight::app {
namespace {

struct ProbeArguments {
  std::string input, layout_in, output, layout_out;
  bool strict = false, overwrite = false, mirror = false;
  int width_px = 0, size_px = 256, preview_px = 1200, bands = 3;
  double ev = 0, yaw_deg = 0;
  std::string lights, rest;
  SceneSettings::Quality quality;  // the split's defaults
};

render::Probe load(const ProbeArguments& arguments, Log& log) {
  if (render::is_made_probe(arguments.input)) return render::make_probe(arguments.input);
  render::ProbeLoadOptions options;
  if (!arguments.layout_in.empty()) options.layout = render::probe_layout_from_name(arguments.layout_in);
  options.strict = arguments.strict;
  return render::load_probe(arguments.input, options, log.warning_handler());
}

std::string shown(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.4g", value);
  return text;
}

std::string shown(const glm::dvec3& v) {
  return shown(v.x) + ' ' + shown(v.y) + ' ' + shown(v.z);
}

void print(const char* name, const std::string& value) {
  std::printf("%-20s %s\n", name, value.c_str());
}

/// A direction with its angles as ImfEnvmap.h counts them: longitude 0 is +z, +90 degrees is +x.
std::string direction_text(const glm::dvec3& d) {
  return shown(d) + " (latitude " + shown(glm::degrees(std::asin(glm::clamp(d.y, -1.0, 1.0)))) + ", longitude " +
         shown(glm::degrees(std::atan2(d.x, d.z))) + " deg)";
}

void print_info(const ProbeArguments& arguments, Log& log) {
  const render::Probe probe = load(arguments, log);
  const ProbeStatistics statistics = measure_probe(probe, arguments.bands);
  print("size", std::to_string(probe.image.width) + "x" + std::to_string(probe.image.height));
  print("layout", name_of(probe.layout));
  print("luminance", "max " + shown(statistics.max) + ", min above 0 " + shown(statistics.min_lit) + ", mean " +
                         shown(statistics.mean) + ", log-average " + shown(statistics.log_average));
  print("range", shown(statistics.range_ev) + " EV");
  print("brightest towards", statistics.max > 0 ? direction_text(statistics.brightest) : "nowhere: the probe is black");
  print("irradiance up", shown(statistics.irradiance_up));
  print("irradiance down", shown(statistics.irradiance_down));
  double held = 0;
  for (std::size_t l = 0; l < statistics.band_energy.size(); ++l) {
    held += statistics.band_energy[l];
    const double share = statistics.energy > 0 ? 100 * held / statistics.energy : 0;
    std::printf("SH band %zu            energy %s, %s %% of all held so far\n", l, shown(statistics.band_energy[l]).c_str(),
                shown(share).c_str());
  }
}

void print_lights(const render::SplitProbe& split) {
  print("lights", std::to_string(split.lights.size()));
  if (split.lights.empty()) return;
  print("rest", "at most " + shown(split.threshold) + " where a light was");
  for (std::size_t i = 0; i < split.lights.size(); ++i) {
    const render::ProbeLight& light = split.lights[i];
    print(("light " + std::to_string(i)).c_str(), "from " + direction_text(light.direction));
    print("  solid angle", shown(light.solid_angle_sr) + " sr");
    print("  irradiance", shown(light.irradiance));
    print("  share", shown(100 * light.share / render::kAverageSurfaces) + " % of all the probe's light");
    print("  samples", std::to_string(light.samples.size()));
  }
}

void check_part(const std::string& path) {
  if (!path.empty() && !path.ends_with(".exr"))
    throw UsageError(path + ": the parts of a probe need float; give a name that ends in .exr");
}

/// None where nothing is to be written.
std::optional<PendingFile> pending_part(const std::string& path, bool overwrite) {
  return path.empty() ? std::nullopt : std::optional<PendingFile>(pending_output(path, overwrite));
}

/// What the rest leaves of the probe.
render::Probe lights_of(const render::Probe& probe, const render::Probe& rest) {
  render::Probe lights = probe;
  for (std::size_t i = 0; i < lights.image.data.size(); ++i) lights.image.data[i] -= rest.image.data[i];
  return lights;
}

void split(const ProbeArguments& arguments, Log& log) {
  check_part(arguments.lights);
  check_part(arguments.rest);
  refuse_shared_files({arguments.lights, arguments.rest}, {arguments.input});
  std::optional<PendingFile> lights = pending_part(arguments.lights, arguments.overwrite);
  std::optional<PendingFile> rest = pending_part(arguments.rest, arguments.overwrite);
  const render::Probe probe = load(arguments, log);
  const SceneSettings::Quality& quality = arguments.quality;
  const render::SplitProbe parts = render::split_lights(probe, {quality.bands, quality.tolerance, quality.light_samples});
  if (lights) render::save_probe(lights->pending_path(), lights_of(probe, parts.rest), render::ExrPrecision::full);
  if (rest) render::save_probe(rest->pending_path(), parts.rest, render::ExrPrecision::full);
  if (lights) lights->commit();
  if (rest) rest->commit();
  print_lights(parts);
}

void convert(const ProbeArguments& arguments, Log& log) {
  std::optional<render::ProbeLayout> layout;
  if (!arguments.layout_out.empty()) layout = render::probe_layout_from_name(arguments.layout_out);
  if (!arguments.output.ends_with(".exr") && !arguments.output.ends_with(".hdr"))
    throw UsageError(arguments.output + ": expected a name that ends in .exr or .hdr");
  refuse_same_file(arguments.output, arguments.input);
  PendingFile output = pending_output(arguments.output, arguments.overwrite);
  render::Probe probe = load(arguments, log);
  if (arguments.mirror) probe = render::mirrored(probe);
  render::save_probe(output.pending_path(), render::convert(probe, layout.value_or(probe.layout), arguments.width_px));
  output.commit();
}

/// In full precision: what a scene of the same name is lit by.
void make(const ProbeArguments& arguments, Log&) {
  if (!arguments.output.ends_with(".exr"))
    throw UsageError(arguments.output + ": a probe is made in float; give -o a name that ends in .exr");
  PendingFile output = pending_output(arguments.output, arguments.overwrite);
  render::save_probe(output.pending_path(), render::make_probe(arguments.input), render::ExrPrecision::full);
  output.commit();
}

std::string sh_text(const ProbeArguments& arguments, const render::ShRgb& coefficients) {
  std::string text =
      "# Spherical harmonics of " + arguments.input + ", " + std::to_string(arguments.bands) +
      " bands, by Catchlight " CATCHLIGHT_VERSION
      ".\n"
      "# Scene-linear radiance, Rec. 709, in the probe frame (+y up; a latlong's middle column is +z, +x is left of it).\n"
      "# Real, orthonormal over the sphere, index l(l+1)+m, without the Condon-Shortley phase:\n"
      "# y(0,0) = 0.282095, y(1,-1) = 0.488603 y, y(1,0) = 0.488603 z, y(1,1) = 0.488603 x.\n"
      "# l m red green blue\n";
  for (int l = 0; l < arguments.bands; ++l)
    for (int m = -l; m <= l; ++m) {
      const glm::vec3& c = coefficients[static_cast<std::size_t>(render::sh_index(l, m))];
      char line[128];
      std::snprintf(line, sizeof line, "%d %d %.9g %.9g %.9g\n", l, m, c.r, c.g, c.b);
      text += line;
    }
  return text;
}

void write_sh(const ProbeArguments& arguments, Log& log) {
  if (!arguments.output.empty()) check_output_path(arguments.output, arguments.overwrite);
  refuse_same_file(arguments.output, arguments.input);
  const std::string text = sh_text(arguments, render::project_to_sh(load(arguments, log), arguments.bands));
  if (arguments.output.empty())
    std::fputs(text.c_str(), stdout);
  else
    write_text_file(arguments.output, text, arguments.overwrite);
}

/// PNG keeps colour apart from coverage: straight alpha, sRGB, blue first as OpenCV has it.
cv::Mat png_pixels(const Image& linear_premultiplied, double ev) {
  cv::Mat pixels(linear_premultiplied.height, linear_premultiplied.width, CV_8UC4);
  for (int y = 0; y < pixels.rows; ++y)
    for (int x = 0; x < pixels.cols; ++x) {
      const float* rgba = linear_premultiplied.pixel(x, y);
      cv::Vec4b& out = pixels.at<cv::Vec4b>(y, x);
      for (int c = 0; c < 3; ++c) {
        const double straight = rgba[3] > 0 ? rgba[c] / rgba[3] * std::exp2(ev) : 0;
        out[2 - c] = static_cast<unsigned char>(std::lround(255 * srgb_from_linear(glm::clamp(straight, 0.0, 1.0))));
      }
      out[3] = static_cast<unsigned char>(std::lround(255 * rgba[3]));
    }
  return pixels;
}

void write_png(const ProbeArguments& arguments, const cv::Mat& pixels) {
  const std::vector<std::uint8_t> png = render::encode_png(pixels);
  write_text_file(arguments.output, {reinterpret_cast<const char*>(png.data()), png.size()}, arguments.overwrite);
}

void check_png_output(const ProbeArguments& arguments) {
  if (!arguments.output.ends_with(".png"))
    throw UsageError(arguments.output + ": the preview is a PNG; give -o a name that ends in .png");
  check_output_path(arguments.output, arguments.overwrite);
  refuse_same_file(arguments.output, arguments.input);
}

void write_ball(const ProbeArguments& arguments, Log& log) {
  check_png_output(arguments);
  write_png(arguments, png_pixels(mirror_ball_preview(load(arguments, log), arguments.yaw_deg, arguments.size_px), arguments.ev));
}

void write_preview(const ProbeArguments& arguments, Log& log) {
  check_png_output(arguments);
  write_png(arguments, probe_preview(load(arguments, log), arguments.yaw_deg, arguments.ev, arguments.preview_px));
}

using Run = void (*)(const ProbeArguments&, Log&);

/// A subcommand with the options that reading a probe needs.
CLI::App& add_probe_command(CLI::App& parent, const char* name, const char* help,
                            const std::shared_ptr<ProbeArguments>& arguments, Run run, Context& context) {
  CLI::App& command = *parent.add_subcommand(name, help);
  command.fallthrough();
  command.add_option("FILE", arguments->input, "OpenEXR or Radiance HDR, or the name of one that is made (probe make)")
      ->required();
  command.add_option("--layout-in", arguments->layout_in,
                     "Layout of FILE, where it does not say: " + quoted_list(name_list<render::ProbeLayout>()));
  command.add_flag("--strict", arguments->strict, "Refuse NaN, infinite and negative texels instead of taking them as 0");
  command.callback([arguments, run, &context] { run(*arguments, context.log); });
  return command;
}

void add_overwrite(CLI::App& command, ProbeArguments& arguments) {
  command.add_flag("-y,--overwrite", arguments.overwrite, "Overwrite the output where it exists");
}

void add_bands(CLI::App& command, int& bands) {
  command.add_option("--bands", bands, "Bands of spherical harmonics (n bands have n^2 coefficients)")
      ->check(CLI::Range(1, render::kMaxShBands))
      ->capture_default_str();
}

void add_split(CLI::App& command, const std::shared_ptr<ProbeArguments>& arguments, Context& context) {
  SceneSettings::Quality& quality = arguments->quality;
  CLI::App& parts = add_probe_command(command, "split", "The lights that are split off, and the rest", arguments, split, context);
  parts.footer(
      "Options as quality.bands, quality.tolerance and quality.light_samples of the scene file. docs/light.md explains them.");
  add_bands(parts, quality.bands);
  parts.add_option("--tolerance", quality.tolerance, "Visible error allowed, as a share of white")
      ->check(CLI::Range(0.0001, 0.5))
      ->capture_default_str();
  parts.add_option("--samples", quality.light_samples, "Of all lights together, at most; 0: no lights")
      ->check(CLI::Range(0, render::kMaxLightSamples))
      ->capture_default_str();
  parts.add_option("--lights", arguments->lights, "Writes the lights alone: an OpenEXR file of the probe's layout, in float");
  parts.add_option("--rest", arguments->rest, "Writes what is left; both add up to the probe");
  add_overwrite(parts, *arguments);
  show_examples(parts,
                {"catchlight probe split room.exr", "catchlight probe split room.exr --lights lights.exr --rest rest.exr"});
}

void add_make(CLI::App& command, const std::shared_ptr<ProbeArguments>& arguments, Context& context) {
  CLI::App& made = *command.add_subcommand("make", "A probe that needs no photographs: overcast, studio or sky");
  made.fallthrough();
  made.footer(
      "As `probe.image` of a scene takes it by name. A sky takes values, all of which may be left out:\n"
      "sky:sun_elevation_deg=35,sun_azimuth_deg=135,turbidity=3 (azimuth from north, the tag's far side, over east; 2 is very\n"
      "clear, 10 hazy), or sky:date=2026-06-21T12:00Z,latitude_deg=48,longitude_deg=11. docs/probes.md shows them.");
  made.add_option("NAME", arguments->input, quoted_list({render::kMadeProbes.begin(), render::kMadeProbes.end()}))->required();
  made.add_option("-o,--output", arguments->output, "OpenEXR file")->required();
  add_overwrite(made, *arguments);
  made.callback([arguments, &context] { make(*arguments, context.log); });
  show_examples(made, {"catchlight probe make studio -o studio.exr",
                       "catchlight probe make sky:date=2026-06-21T12:00Z,latitude_deg=48,longitude_deg=11 -o noon.exr"});
}

void add_ball(CLI::App& command, const std::shared_ptr<ProbeArguments>& arguments, Context& context) {
  CLI::App& ball =
      add_probe_command(command, "ball", "Preview: a mirror ball on the tag in this light", arguments, write_ball, context);
  ball.footer(
      "The camera stands in front of the tag (at tag -y) and looks at it horizontally: right is tag +x, up is tag +z, and the "
      "middle of\n"
      "the ball mirrors the camera. What stood behind the camera in the real place has to be seen in the middle.");
  ball.add_option("-o,--output", arguments->output, "PNG file")->required();
  ball.add_option("--size", arguments->size_px, "Width and height in pixels")->check(CLI::Range(8, 8192))->capture_default_str();
  ball.add_option("--ev", arguments->ev, "Exposure")->check(CLI::Range(-30.0, 30.0))->capture_default_str();
  ball.add_option("--yaw", arguments->yaw_deg, "As probe.yaw_deg of the scene file")->check(CLI::Range(-360.0, 360.0));
  add_overwrite(ball, *arguments);
  show_examples(ball,
                {"catchlight probe ball room.exr -o ball.png", "catchlight probe ball room.exr --yaw 40 --ev -2 -o ball.png"});
}

void add_preview(CLI::App& command, const std::shared_ptr<ProbeArguments>& arguments, Context& context) {
  CLI::App& preview =
      add_probe_command(command, "preview", "Shows which way round: panorama, balls, plan", arguments, write_preview, context);
  preview.footer("For a tag flat on a table. docs/probes.md says how to read it.");
  preview.add_option("-o,--output", arguments->output, "PNG file")->required();
  preview.add_option("--size", arguments->preview_px, "Width in pixels")->check(CLI::Range(300, 8192))->capture_default_str();
  preview.add_option("--ev", arguments->ev, "Brighter or darker")->check(CLI::Range(-30.0, 30.0))->capture_default_str();
  preview.add_option("--yaw", arguments->yaw_deg, "As probe.yaw_deg of the scene file")->check(CLI::Range(-360.0, 360.0));
  add_overwrite(preview, *arguments);
  show_examples(
      preview, {"catchlight probe preview room.exr -o preview.png", "catchlight probe preview room.exr --yaw 40 -o preview.png"});
}

}  // namespace

void set_up_probe(CLI::App& command, Context& context) {
  command.require_subcommand(1);
  const auto arguments = std::make_shared<ProbeArguments>();
  add_probe_merge(command, context);
  add_make(command, arguments, context);

  CLI::App& info = add_probe_command(command, "info", "Size, range, where the light comes from", arguments, print_info, context);
  add_bands(info, arguments->bands);
  show_examples(info, {"catchlight probe info room.exr", "catchlight probe info ball.hdr --layout-in mirror-ball"});

  add_split(command, arguments, context);

  CLI::App& converted = add_probe_command(command, "convert", "The same light in another layout", arguments, convert, context);
  converted.add_option("OUT", arguments->output, "OpenEXR or Radiance HDR, by extension")->required();
  converted.add_option("--layout", arguments->layout_out,
                       "Layout of OUT, where not FILE's own: " + quoted_list(name_list<render::ProbeLayout>()));
  converted.add_flag("--mirror", arguments->mirror, "Exchange left and right, for a probe in which writing is mirrored");
  converted.add_option("--width", arguments->width_px, "Width of OUT in texels; 0 keeps the angular resolution")
      ->check(CLI::Range(0, 16384));
  add_overwrite(converted, *arguments);
  show_examples(converted,
                {"catchlight probe convert room.exr cross.hdr --layout cube-cross",
                 "catchlight probe convert map.hdr room.exr --layout-in angular-inside --layout latlong --width 2048"});

  CLI::App& sh = add_probe_command(command, "sh", "Coefficients of spherical harmonics as text", arguments, write_sh, context);
  add_bands(sh, arguments->bands);
  sh.add_option("-o,--output", arguments->output, "Text file; stdout where left out");
  add_overwrite(sh, *arguments);
  show_examples(sh, {"catchlight probe sh room.exr", "catchlight probe sh room.exr --bands 5 -o room.txt"});

  add_ball(command, arguments, context);
  add_preview(command, arguments, context);
  show_examples(command, {"catchlight probe preview room.exr -o preview.png", "catchlight help probe merge"});
}

}  // namespace catchlight::app
