#include "render/gl/gl_context.hpp"

#include <epoxy/egl.h>
#include <epoxy/gl.h>

#include <array>
#include <filesystem>
#include <utility>
#include <vector>

#include "catchlight/error.hpp"

namespace catchlight::render {
namespace {

// GL reports on the thread that made the call, so messages of one thread's context never reach another's check_gl().
thread_local std::string pending_message;
thread_local std::string current_platform = "unknown";

void GLAPIENTRY remember_message(GLenum source, GLenum, GLuint, GLenum severity, GLsizei length, const GLchar* text,
                                 const void*) {
  // Program reports what compilers say, with the files' names.
  if (source == GL_DEBUG_SOURCE_SHADER_COMPILER) return;
  // An exception must not cross the driver's frames: keep the first message until check_gl().
  if (severity == GL_DEBUG_SEVERITY_HIGH && pending_message.empty()) pending_message.assign(text, length);
}

std::string egl_error_text() {
  switch (const EGLint code = eglGetError()) {
    case EGL_SUCCESS:
      return "no reason given";
    case EGL_NOT_INITIALIZED:
      return "EGL_NOT_INITIALIZED";
    case EGL_BAD_ALLOC:
      return "EGL_BAD_ALLOC";
    case EGL_BAD_ATTRIBUTE:
      return "EGL_BAD_ATTRIBUTE";
    case EGL_BAD_CONFIG:
      return "EGL_BAD_CONFIG";
    case EGL_BAD_DISPLAY:
      return "EGL_BAD_DISPLAY";
    case EGL_BAD_MATCH:
      return "EGL_BAD_MATCH (no OpenGL 4.5 core)";
    case EGL_BAD_PARAMETER:
      return "EGL_BAD_PARAMETER";
    default:
      return "EGL error " + std::to_string(code);
  }
}

struct Candidate {
  std::string platform;
  EGLDisplay display;
};

std::vector<Candidate> device_displays() {
  std::vector<Candidate> candidates;
  if (!epoxy_has_egl_extension(EGL_NO_DISPLAY, "EGL_EXT_platform_device") ||
      !epoxy_has_egl_extension(EGL_NO_DISPLAY, "EGL_EXT_device_enumeration")) {
    return candidates;
  }
  std::array<EGLDeviceEXT, 16> devices{};
  EGLint count = 0;
  if (!eglQueryDevicesEXT(static_cast<EGLint>(devices.size()), devices.data(), &count)) return candidates;
  for (int i = 0; i < count; ++i) {
    candidates.push_back({"EGL device " + std::to_string(i),
                          eglGetPlatformDisplayEXT(EGL_PLATFORM_DEVICE_EXT, devices[static_cast<std::size_t>(i)], nullptr)});
  }
  return candidates;
}

std::vector<Candidate> all_displays() {
  std::vector<Candidate> candidates = device_displays();
  if (epoxy_has_egl_extension(EGL_NO_DISPLAY, "EGL_MESA_platform_surfaceless")) {
    candidates.push_back(
        {"EGL surfaceless", eglGetPlatformDisplayEXT(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, nullptr)});
  }
  candidates.push_back({"EGL default display", eglGetDisplay(EGL_DEFAULT_DISPLAY)});
  return candidates;
}

class HeadlessContext : public GlContext {
 public:
  HeadlessContext(EGLDisplay display, EGLContext context) : display_(display), context_(context) {}
  ~HeadlessContext() override {
    // The display is the process's own and may carry other contexts: it is not terminated.
    if (eglGetCurrentContext() == context_) eglMakeCurrent(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
    eglDestroyContext(display_, context_);
  }
  void make_current() override {
    if (eglGetCurrentContext() == context_) return;
    if (!eglMakeCurrent(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, context_))
      throw Error("the OpenGL context cannot be made current; another thread may be drawing with it");
  }
  HeadlessContext(const HeadlessContext&) = delete;
  HeadlessContext& operator=(const HeadlessContext&) = delete;

 private:
  EGLDisplay display_;
  EGLContext context_;
};

/// A current context on `display`, or null and the reason.
std::unique_ptr<GlContext> try_display(EGLDisplay display, std::string& reason) {
  const auto fail = [&](const char* call) {
    reason = std::string(call) + ": " + egl_error_text();
    return nullptr;
  };
  if (display == EGL_NO_DISPLAY) return fail("no display");
  if (!eglInitialize(display, nullptr, nullptr)) return fail("eglInitialize");
  if (!epoxy_has_egl_extension(display, "EGL_KHR_surfaceless_context")) return fail("EGL_KHR_surfaceless_context is missing");
  if (!eglBindAPI(EGL_OPENGL_API)) return fail("eglBindAPI(OpenGL)");
  EGLConfig config = EGL_NO_CONFIG_KHR;
  if (!epoxy_has_egl_extension(display, "EGL_KHR_no_config_context")) {
    const EGLint wanted[] = {EGL_SURFACE_TYPE, EGL_PBUFFER_BIT, EGL_RENDERABLE_TYPE, EGL_OPENGL_BIT, EGL_NONE};
    EGLint count = 0;
    if (!eglChooseConfig(display, wanted, &config, 1, &count) || count == 0) return fail("eglChooseConfig");
  }
  const EGLint attributes[] = {
      EGL_CONTEXT_MAJOR_VERSION,           4,       EGL_CONTEXT_MINOR_VERSION, 5, EGL_CONTEXT_OPENGL_PROFILE_MASK,
      EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT, EGL_NONE};
  const EGLContext context = eglCreateContext(display, config, EGL_NO_CONTEXT, attributes);
  if (context == EGL_NO_CONTEXT) return fail("eglCreateContext");
  auto owner = std::make_unique<HeadlessContext>(display, context);
  if (!eglMakeCurrent(display, EGL_NO_SURFACE, EGL_NO_SURFACE, context)) return fail("eglMakeCurrent");
  return owner;
}

/// Without a device that a card's driver makes, no driver can find a card.
bool may_have_card() {
  namespace fs = std::filesystem;
  std::error_code missing;
  for (const char* file : {"/dev/nvidiactl", "/dev/dxg", "/dev/mali0", "/dev/kgsl-3d0"})
    if (fs::exists(file, missing)) return true;
  for (const fs::directory_entry& entry : fs::directory_iterator("/dev/dri", missing))
    if (entry.path().filename().string().starts_with("renderD")) return true;
  return false;
}

std::string gl_string(GLenum name) {
  const auto* text = reinterpret_cast<const char*>(glGetString(name));
  return text ? text : "";
}

}  // namespace

std::unique_ptr<GlContext> make_headless_context() {
  std::string reasons;
  for (const auto& [platform, display] : all_displays()) {
    std::string reason;
    if (auto context = try_display(display, reason)) {
      current_platform = platform;
      install_debug_callback();
      return context;
    }
    reasons += "\n  " + platform + ": " + reason;
  }
  throw Error(
      "no OpenGL 4.5 core context without a window; install Mesa (libegl1, libgl1-mesa-dri) or a vendor's EGL driver. Tried:" +
      reasons);
}

std::unique_ptr<GlContext> make_hardware_context() {
  if (!may_have_card()) return nullptr;
  std::unique_ptr<GlContext> context;
  try {
    context = make_headless_context();
  } catch (const Error&) {
    return nullptr;  // a card without a driver
  }
  const std::string renderer = gl_info().renderer;
  for (const char* rasteriser : {"llvmpipe", "softpipe", "swrast", "SwiftShader", "Software Rasterizer"})
    if (renderer.find(rasteriser) != std::string::npos) return nullptr;
  return context;
}

GlInfo gl_info() {
  return {gl_string(GL_VENDOR), gl_string(GL_RENDERER), gl_string(GL_VERSION), gl_string(GL_SHADING_LANGUAGE_VERSION),
          current_platform};
}

void install_debug_callback() {
  pending_message.clear();
  glEnable(GL_DEBUG_OUTPUT);
  glEnable(GL_DEBUG_OUTPUT_SYNCHRONOUS);
  glDebugMessageCallback(remember_message, nullptr);
}

void check_gl(const std::string& where) {
  std::string message = std::exchange(pending_message, {});
  // Contexts without the debug flag may keep silent; the error flag never does. Bounded: a lost context reports errors for ever.
  for (int i = 0; i < 16; ++i) {
    const GLenum code = glGetError();
    if (code == GL_NO_ERROR) break;
    if (message.empty()) message = "GL error " + std::to_string(code);
  }
  if (!message.empty()) throw Error("OpenGL failed in " + where + ": " + message);
}

}  // namespace catchlight::render
