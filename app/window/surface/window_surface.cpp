#include <epoxy/gl.h>
// After the loader of OpenGL.
#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <backends/imgui_impl_glfw.h>
#include <backends/imgui_impl_opengl3.h>
#include <imgui.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <utility>

#include "app/window/surface/gui_picture.hpp"
#include "app/window/surface/gui_style.hpp"
#include "app/window/surface/gui_surface.hpp"
#include "catchlight/error.hpp"
#include "render/gl/gl_context.hpp"

namespace catchlight::app {
namespace {

std::string last_glfw_error() {
  const char* text = nullptr;
  return glfwGetError(&text) != GLFW_NO_ERROR && text ? text : "no reason given";
}

/// GLFW from its start to its end.
class Glfw {
 public:
  Glfw() {
    if (!glfwInit())
      throw Error("no window can be opened: " + last_glfw_error() +
                  "; run this on a desktop, or without a window: --frames N --screenshot FILE");
  }
  ~Glfw() { glfwTerminate(); }
  Glfw(const Glfw&) = delete;
  Glfw& operator=(const Glfw&) = delete;
};

class WindowSurface final : public GuiSurface {
 public:
  WindowSurface(const glm::ivec2& size, const std::string& title, std::optional<double> scale, bool is_driven)
      : given_scale_(scale), is_driven_(is_driven) {
    glfwWindowHint(GLFW_CONTEXT_VERSION_MAJOR, 4);
    glfwWindowHint(GLFW_CONTEXT_VERSION_MINOR, 5);
    glfwWindowHint(GLFW_OPENGL_PROFILE, GLFW_OPENGL_CORE_PROFILE);
    glfwWindowHint(GLFW_SCALE_TO_MONITOR, scale ? GLFW_FALSE : GLFW_TRUE);  // which makes the size one in units
    const glm::ivec2 asked(scale.value_or(1) * glm::dvec2(size));
    window_.reset(glfwCreateWindow(asked.x, asked.y, title.c_str(), nullptr, nullptr));
    if (!window_)
      throw Error("no window with OpenGL 4.5: " + last_glfw_error() +
                  "; install Mesa (libgl1, libgl1-mesa-dri) or the graphics card's driver");
    glfwMakeContextCurrent(window_.get());
    glfwSwapInterval(1);
    glfwSetWindowUserPointer(window_.get(), this);
    glfwSetDropCallback(window_.get(), [](GLFWwindow* window, int count, const char** paths) {
      auto* self = static_cast<WindowSurface*>(glfwGetWindowUserPointer(window));
      self->dropped_.insert(self->dropped_.end(), paths, paths + count);
    });
    render::install_debug_callback();
    ImGui::CreateContext();
    ImGui::GetIO().IniFilename = nullptr;
    scale_ = display_scale();
    set_gui_style(scale_);
    ImGui_ImplGlfw_InitForOpenGL(window_.get(), true);
    ImGui_ImplOpenGL3_Init("#version 450");
  }
  ~WindowSurface() override {
    ImGui_ImplOpenGL3_Shutdown();
    ImGui_ImplGlfw_Shutdown();
    ImGui::DestroyContext();
  }
  WindowSurface(const WindowSurface&) = delete;
  WindowSurface& operator=(const WindowSurface&) = delete;

  void begin_frame() override {
    glfwMakeContextCurrent(window_.get());
    glfwPollEvents();
    follow_display();
    ImGui_ImplOpenGL3_NewFrame();
    begin_input();
    ImGui::NewFrame();
  }

  void end_frame() override {
    glm::ivec2 size_px(0);
    glfwGetFramebufferSize(window_.get(), &size_px.x, &size_px.y);
    picture_.draw(glm::max(size_px, 1));
    picture_.show();
    glfwSwapBuffers(window_.get());
  }

  void rest(double seconds) override { glfwWaitEventsTimeout(seconds); }
  void wake() override { glfwPostEmptyEvent(); }

  bool is_closed() const override { return glfwWindowShouldClose(window_.get()) != 0; }
  void keep_open() override { glfwSetWindowShouldClose(window_.get(), GLFW_FALSE); }
  std::vector<std::string> take_dropped_files() override { return std::exchange(dropped_, {}); }
  void set_title(const std::string& title) override { glfwSetWindowTitle(window_.get(), title.c_str()); }
  float scale() const override { return scale_; }
  RgbPicture picture() const override { return picture_.read(); }

 private:
  /// GLFW's pointer is the hand's: a script's stays as it was set.
  void begin_input() {
    ImGuiIO& io = ImGui::GetIO();
    const ImVec2 pointer = io.MousePos;
    const auto buttons = std::to_array(io.MouseDown);
    ImGui_ImplGlfw_NewFrame();
    if (!is_driven_) return;
    io.MousePos = pointer;
    std::ranges::copy(buttons, io.MouseDown);
  }

  float display_scale() const {
    float across = 1, down = 1;
    glfwGetWindowContentScale(window_.get(), &across, &down);
    return given_scale_ ? static_cast<float>(*given_scale_) : std::max(across, 0.5f);
  }

  /// Where the window was moved to a display of another scale, type and controls get that.
  void follow_display() {
    if (display_scale() == scale_) return;
    scale_ = display_scale();
    set_gui_style(scale_);
    ImGui_ImplOpenGL3_DestroyFontsTexture();
    ImGui_ImplOpenGL3_CreateFontsTexture();
  }

  Glfw glfw_;
  struct Destroy {
    void operator()(GLFWwindow* window) const { glfwDestroyWindow(window); }
  };
  std::unique_ptr<GLFWwindow, Destroy> window_;  ///< goes after what is drawn in it
  std::optional<double> given_scale_;
  bool is_driven_;
  float scale_ = 1;
  std::vector<std::string> dropped_;
  GuiPicture picture_;
};

}  // namespace

std::unique_ptr<GuiSurface> make_window_surface(const glm::ivec2& size, const std::string& title, std::optional<double> scale,
                                                bool is_driven) {
  return std::make_unique<WindowSurface>(size, title, scale, is_driven);
}

}  // namespace catchlight::app
