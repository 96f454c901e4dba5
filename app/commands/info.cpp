#include <embree3/rtcore.h>

#include <OpenEXR/OpenEXRConfig.h>
#include <CLI/CLI.hpp>
#include <cstdio>
#include <fstream>
#include <opencv2/core.hpp>
#include <thread>

#include "app/commands/commands.hpp"
#include "app/commands/help.hpp"
#include "catchlight/error.hpp"
#include "render/cache/content_cache.hpp"
#include "render/gl/gl_context.hpp"
#include "tracking/detection/families.hpp"

extern "C" {
#include <libavcodec/avcodec.h>
#include <libavformat/avformat.h>
#include <libavutil/avutil.h>
#include <libswscale/swscale.h>
}

namespace catchlight::app {
namespace {

void print(const std::string& name, const std::string& value) {
  std::printf("%-18s %s\n", name.c_str(), value.c_str());
}

/// The version as text; FFmpeg's libraries pack it into one number.
std::string ffmpeg_version(unsigned packed) {
  return std::to_string(AV_VERSION_MAJOR(packed)) + '.' + std::to_string(AV_VERSION_MINOR(packed)) + '.' +
         std::to_string(AV_VERSION_MICRO(packed));
}

std::string embree_version() {
  const RTCDevice device = rtcNewDevice(nullptr);
  if (!device) return "cannot be started";
  const auto property = [&](RTCDeviceProperty which) { return std::to_string(rtcGetDeviceProperty(device, which)); };
  const std::string version = property(RTC_DEVICE_PROPERTY_VERSION_MAJOR) + '.' + property(RTC_DEVICE_PROPERTY_VERSION_MINOR) +
                              '.' + property(RTC_DEVICE_PROPERTY_VERSION_PATCH);
  rtcReleaseDevice(device);
  return version;
}

std::string processor() {
  std::ifstream file("/proc/cpuinfo");
  for (std::string line; std::getline(file, line);)
    if (line.starts_with("model name")) return line.substr(line.find(':') + 2);
  return "unknown processor";
}

void print_libraries() {
  print("libavformat", ffmpeg_version(avformat_version()));
  print("libavcodec", ffmpeg_version(avcodec_version()));
  print("libavutil", ffmpeg_version(avutil_version()));
  print("libswscale", ffmpeg_version(swscale_version()));
  print("OpenCV", cv::getVersionString());
  print("OpenEXR", OPENEXR_VERSION_STRING);
  print("Embree", embree_version());
  std::string families;
  for (const std::string& family : tracking::tag_families()) families += (families.empty() ? "" : ", ") + family;
  print("AprilTag families", families);
}

void print_graphics() {
  try {
    const auto context = render::make_headless_context();
    const render::GlInfo gl = render::gl_info();
    print("GL vendor", gl.vendor);
    print("GL renderer", gl.renderer);
    print("GL version", gl.version);
    print("GLSL version", gl.glsl_version);
    print("EGL platform", gl.platform);
  } catch (const Error& error) {
    print("GL", std::string("none: ") + error.what());
  }
  const bool has_card = render::make_hardware_context() != nullptr;
  print("--renderer auto", has_card ? "gl: there is a graphics card" : "cpu: there is no graphics card that GL can use");
}

}  // namespace

void set_up_info(CLI::App& command, Context&) {
  command.footer("What was made for scenes is kept in the cache; XDG_CACHE_HOME names another folder for it.");
  show_examples(command, {"catchlight info", "catchlight info > report.txt"});
  command.callback([] {
    print("Catchlight", CATCHLIGHT_VERSION);
    print_libraries();
    print("Processor", processor() + ", " + std::to_string(std::thread::hardware_concurrency()) + " threads");
    print("Cache", render::default_cache_folder());
    print_graphics();
  });
}

}  // namespace catchlight::app
