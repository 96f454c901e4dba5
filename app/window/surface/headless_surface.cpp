#include <backends/imgui_impl_opengl3.h>
#include <imgui.h>

#include <chrono>
#include <condition_variable>
#include <mutex>

#include "app/window/surface/gui_keys.hpp"
#include "app/window/surface/gui_picture.hpp"
#include "app/window/surface/gui_style.hpp"
#include "app/window/surface/gui_surface.hpp"
#include "render/gl/gl_context.hpp"

namespace catchlight::app {
namespace {

class HeadlessSurface final : public GuiSurface {
 public:
  HeadlessSurface(const glm::ivec2& size, double scale)
      : context_(render::make_headless_context()), size_px_(scale * glm::dvec2(size)), scale_(static_cast<float>(scale)) {
    ImGui::CreateContext();
    ImGuiIO& io = ImGui::GetIO();
    io.IniFilename = nullptr;
    io.DisplaySize = {static_cast<float>(size_px_.x), static_cast<float>(size_px_.y)};
    io.MousePos = {-1, -1};
    set_key_map(io);
    set_gui_style(scale_);
    ImGui_ImplOpenGL3_Init("#version 450");
  }
  ~HeadlessSurface() override {
    ImGui_ImplOpenGL3_Shutdown();
    ImGui::DestroyContext();
  }
  HeadlessSurface(const HeadlessSurface&) = delete;
  HeadlessSurface& operator=(const HeadlessSurface&) = delete;

  void begin_frame() override {
    context_->make_current();
    ImGui::GetIO().DeltaTime = 1.0f / 60;
    ImGui_ImplOpenGL3_NewFrame();
    ImGui::NewFrame();
  }

  void end_frame() override { picture_.draw(size_px_); }

  void rest(double seconds) override {
    std::unique_lock lock(mutex_);
    woken_.wait_for(lock, std::chrono::duration<double>(seconds), [&] { return is_woken_; });
    is_woken_ = false;
  }
  void wake() override {
    const std::lock_guard lock(mutex_);
    is_woken_ = true;
    woken_.notify_one();
  }

  bool is_closed() const override { return false; }
  void keep_open() override {}
  std::vector<std::string> take_dropped_files() override { return {}; }
  void set_title(const std::string&) override {}
  float scale() const override { return scale_; }

  RgbPicture picture() const override { return picture_.read(); }

 private:
  std::unique_ptr<render::GlContext> context_;
  glm::ivec2 size_px_;
  float scale_;
  GuiPicture picture_;
  std::mutex mutex_;
  std::condition_variable woken_;
  bool is_woken_ = false;
};

}  // namespace

std::unique_ptr<GuiSurface> make_headless_surface(const glm::ivec2& size, double scale) {
  return std::make_unique<HeadlessSurface>(size, scale);
}

}  // namespace catchlight::app
