#include <CLI/CLI.hpp>
#include <cstdlib>
#include <memory>
#include <optional>

#include "app/commands/commands.hpp"
#include "app/commands/help.hpp"
#include "app/window/tune_window.hpp"
#include "app/window/ui_script.hpp"
#include "catchlight/error.hpp"

namespace catchlight::app {
namespace {

struct Options {
  std::string recording, screenshot, script, size;
  RecordingOverrides overrides;
  std::optional<double> scale;
  int frames = 0;
  bool is_headless = false;
};

glm::ivec2 size_of(const std::string& text) {
  glm::ivec2 size(0);
  char end = 0;
  if (std::sscanf(text.c_str(), "%dx%d%c", &size.x, &size.y, &end) != 2 || size.x < 320 || size.y < 200 || size.x > 8192 ||
      size.y > 8192)
    throw UsageError("--size " + text + ": expected WIDTHxHEIGHT, 320x200 to 8192x8192");
  return size;
}

/// Frames until `--frames` have been drawn and everything asked for is shown, or until the script has ended.
void run_without_person(const Options& options, TuneWindow& window, GuiSurface& surface, std::optional<UiScript>& script) {
  window.frame();  // now there are controls to click
  for (int frame = 1; !window.is_done(); ++frame) {
    if (script) script->before_frame(window);
    window.frame();
    const bool is_over = script ? script->is_done() : frame + 1 >= std::max(options.frames, 1);
    if (is_over && window.is_idle()) return;
    if (!window.is_idle() || (script && script->is_waiting())) surface.rest(1.0 / 60);  // the player needs the cores
  }
}

/// Windows without a person are as they are asked for, and leave no trace, but where tests say where to.
bool remembers(bool is_headless) {
  const char* state_home = std::getenv("XDG_STATE_HOME");
  return !is_headless || (state_home && *state_home);
}

void tune(const Options& options, Log& log) {
  std::optional<UiScript> script;
  if (!options.script.empty()) script.emplace(options.script, read_ui_script(options.script));
  const bool is_headless = options.is_headless || options.frames > 0;
  const TuneState state = remembers(is_headless) ? read_tune_state(tune_state_file(), log.warning_handler()) : TuneState{};
  const glm::ivec2 size = options.size.empty() ? glm::ivec2(state.width, state.height) : size_of(options.size);
  const std::unique_ptr<GuiSurface> surface = is_headless
                                                  ? make_headless_surface(size, options.scale.value_or(1))
                                                  : make_window_surface(size, "Catchlight", options.scale, script.has_value());
  TuneWindow window(*surface, {options.recording, options.overrides}, state);
  if (script || is_headless)
    run_without_person(options, window, *surface, script);
  else
    while (!window.is_done()) window.frame(), surface->rest(window.rest_s());
  if (remembers(is_headless)) write_tune_state(tune_state_file(), window.state(), log.warning_handler());
  if (options.screenshot.empty()) return;
  window.screenshot(options.screenshot);
  window.frame();
}

}  // namespace

void set_up_tune(CLI::App& command, Context& context) {
  const auto options = std::make_shared<Options>();
  add_recording_options(command, context, options->recording, options->overrides);
  command.get_option("RECORDING")->required(false);
  add_renderer_options(command, options->overrides);
  command.add_option("--size", options->size,
                     "of the window, in units of which a pixel of the screen may be a part; as it was last, at first 1280x720");
  command.add_option("--scale", options->scale, "pixels of the screen a unit, instead of what the display says")
      ->check(CLI::Range(0.5, 4.0));
  command.add_option("--ui-script", options->script, "do what the script says (docs/tuning.md), and end with it");
  command.add_flag("--headless", options->is_headless, "draw the window into memory: no screen is needed");
  command.add_option("--frames", options->frames, "without a screen: draw so many frames of the window, and end")
      ->check(CLI::Range(0, 1'000'000));
  command.add_option("--screenshot", options->screenshot, "write what the window shows in the end, PNG");
  show_examples(command, {"catchlight tune recordings/matte",
                          "catchlight tune my-shot --headless --ui-script turn.txt --screenshot window.png"});
  command.callback([options, &context] { tune(*options, context.log); });
}

}  // namespace catchlight::app
