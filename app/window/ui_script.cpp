#include "app/window/ui_script.hpp"

#include <algorithm>
#include <array>
#include <fstream>
#include <sstream>

#include "app/window/surface/gui_keys.hpp"
#include "catchlight/error.hpp"
#include "catchlight/util/text.hpp"

namespace catchlight::app {
namespace {

struct Verb {
  const char* name;
  std::size_t min_words;
  const char* form;
};
constexpr std::array kVerbs{
    Verb{"open", 1, "open RECORDING"},
    Verb{"drop", 1, "drop FILE"},
    Verb{"seek", 1, "seek FRAME"},
    Verb{"set", 2, "set KEY VALUE"},
    Verb{"click", 1, "click CONTROL"},
    Verb{"drag", 3, "drag CONTROL FROM TO (shares of its width), or FROM_X FROM_Y TO_X TO_Y"},
    Verb{"wheel", 2, "wheel CONTROL STEPS"},
    Verb{"type", 1, "type TEXT"},
    Verb{"key", 1, "key NAME, ctrl+NAME, ctrl+shift+NAME"},
    Verb{"wait", 0,
         "wait: until everything asked for is shown; wait STAGE: until that has begun; wait KEY VALUE: until expect holds"},
    Verb{"hold", 1, "hold NAME (a key, shift, ctrl, alt)"},
    Verb{"release", 0, "release"},
    Verb{"screenshot", 1, "screenshot FILE"},
    Verb{"picture", 1, "picture FILE"},
    Verb{"expect", 2, "expect KEY VALUE, KEY < NUMBER, KEY > NUMBER"},
    Verb{"save", 0, "save [FILE]"},
    Verb{"quit", 0, "quit"},
};

std::string joined(const std::vector<std::string>& words, std::size_t first, std::size_t end) {
  std::string text;
  for (std::size_t i = first; i < end; ++i) text += (i > first ? " " : "") + words[i];
  return text;
}

std::string after(const ScriptCommand& command, std::size_t first) {
  return joined(command.words, first, command.words.size());
}

}  // namespace

std::vector<ScriptCommand> read_ui_script(const std::string& path) {
  std::ifstream file(path);
  if (!file) throw Error(path + ": cannot be read; expected a script for the window");
  std::vector<ScriptCommand> commands;
  int number = 0;
  for (std::string line; std::getline(file, line);) {
    ++number;
    std::istringstream words(line.substr(0, line.find('#')));
    ScriptCommand command{number, "", {}};
    if (!(words >> command.verb)) continue;
    for (std::string word; words >> word;) command.words.push_back(word);
    const auto verb = std::ranges::find_if(kVerbs, [&](const Verb& v) { return command.verb == v.name; });
    const std::string where = path + ":" + std::to_string(number) + ": ";
    if (verb == kVerbs.end()) {
      std::vector<std::string> names;
      names.reserve(kVerbs.size());
      for (const Verb& known : kVerbs) names.emplace_back(known.name);
      throw Error(where + "unknown command '" + command.verb + "'; did you mean '" + nearest(command.verb, names) + "'?");
    }
    if (command.words.size() < verb->min_words) throw Error(where + "expected: " + verb->form);
    commands.push_back(std::move(command));
  }
  return commands;
}

UiScript::UiScript(std::string path, std::vector<ScriptCommand> commands)
    : path_(std::move(path)), commands_(std::move(commands)) {}

GuiItems::Rect UiScript::rect_of(const ScriptTarget& target, const std::string& control) const {
  const auto rect = target.items().find(control);
  if (!rect) throw Error("there is no control '" + control + "' in the window now");
  return *rect;
}

ImVec2 UiScript::middle_of(const ScriptTarget& target, const std::string& control) const {
  const GuiItems::Rect rect = rect_of(target, control);
  return {0.5f * (rect.min.x + rect.max.x), 0.5f * (rect.min.y + rect.max.y)};
}

void UiScript::click(const ImVec2& at) {
  gestures_.push_back([at](ImGuiIO& io) { io.MousePos = at; });
  gestures_.push_back([](ImGuiIO& io) { io.MouseDown[0] = true; });
  gestures_.push_back([](ImGuiIO& io) { io.MouseDown[0] = false; });
  gestures_.push_back([](ImGuiIO&) {});
}

void UiScript::drag(const ImVec2& from, const ImVec2& to) {
  constexpr int kSteps = 8;
  gestures_.push_back([from](ImGuiIO& io) { io.MousePos = from; });
  gestures_.push_back([](ImGuiIO& io) { io.MouseDown[0] = true; });
  for (int step = 1; step <= kSteps; ++step)
    gestures_.push_back([from, to, share = static_cast<float>(step) / kSteps](ImGuiIO& io) {
      io.MousePos = {from.x + share * (to.x - from.x), from.y + share * (to.y - from.y)};
    });
  gestures_.push_back([](ImGuiIO& io) { io.MouseDown[0] = false; });
  gestures_.push_back([](ImGuiIO&) {});
}

float UiScript::number(const ScriptCommand& command, std::size_t word) const {
  const auto value = real_from_text(command.words[word]);
  if (!value) throw Error("'" + command.words[word] + "' is no number");
  return static_cast<float>(*value);
}

void UiScript::begin(ScriptTarget& target, const ScriptCommand& command) {
  const std::string& verb = command.verb;
  const auto& words = command.words;
  if (verb == "open") return target.open(after(command, 0));
  if (verb == "drop") return target.drop(after(command, 0));
  if (verb == "seek") return target.seek(static_cast<std::int64_t>(number(command, 0)));
  if (verb == "set") return target.set(words[0], after(command, 1));
  if (verb == "screenshot") return target.screenshot(words[0]);
  if (verb == "picture") return target.picture(words[0]);
  if (verb == "save") return target.save(after(command, 0));
  if (verb == "quit") return target.quit();
  if (verb == "click") return click(middle_of(target, after(command, 0)));
  if (verb == "wheel") return turn_wheel(middle_of(target, words[0]), number(command, 1));
  if (verb == "drag") return drag_along(target, command);
  if (verb == "type") return type(after(command, 0));
  if (verb == "key") return press(command);
  if (verb == "hold") return hold(command);
  if (verb == "release") return release();
  if (verb == "expect" && !holds(target, command))
    throw Error(words[0] + " is " + target.value_of(words[0]) + ", expected " + after(command, 1));
}

/// Whether what the command names has the value that it says.
bool UiScript::holds(const ScriptTarget& target, const ScriptCommand& command) const {
  const std::string value = target.value_of(command.words[0]), wanted = after(command, 1);
  const bool is_less = wanted.starts_with("< "), is_more = wanted.starts_with("> ");
  if (!is_less && !is_more) return value == wanted;
  const auto number = real_from_text(value), limit = real_from_text(wanted.substr(2));
  return number && limit && (is_less ? *number < *limit : *number > *limit);
}

/// Whether there is what `wait` waits for.
bool UiScript::is_reached(const ScriptTarget& target, const ScriptCommand& command) const {
  if (command.words.size() > 1) return holds(target, command);
  return target.is_idle() || (!command.words.empty() && target.value_of("stage") == command.words[0]);
}

void UiScript::turn_wheel(const ImVec2& at, float steps) {
  gestures_.push_back([at](ImGuiIO& io) { io.MousePos = at; });
  gestures_.push_back([steps](ImGuiIO& io) { io.MouseWheel = steps; });
  gestures_.push_back([](ImGuiIO& io) { io.MouseWheel = 0; });
}

void UiScript::drag_along(const ScriptTarget& target, const ScriptCommand& command) {
  const auto& words = command.words;
  if (words.size() >= 4 && real_from_text(words[0]))
    return drag({number(command, 0), number(command, 1)}, {number(command, 2), number(command, 3)});
  const std::size_t from = words.size() - 2, to = words.size() - 1;
  const GuiItems::Rect rect = rect_of(target, joined(words, 0, from));
  const float y = 0.5f * (rect.min.y + rect.max.y), width = rect.max.x - rect.min.x;
  drag({rect.min.x + number(command, from) * width, y}, {rect.min.x + number(command, to) * width, y});
}

void UiScript::type(const std::string& text) {
  gestures_.push_back([text](ImGuiIO& io) { io.AddInputCharactersUTF8(text.c_str()); });
  gestures_.push_back([](ImGuiIO&) {});
}

void UiScript::press(const ScriptCommand& command) {
  std::string name = command.words[0];
  bool with_ctrl = false, with_shift = false;
  for (; name.starts_with("ctrl+"); name.erase(0, 5)) with_ctrl = true;
  for (; name.starts_with("shift+"); name.erase(0, 6)) with_shift = true;
  const auto key = key_number(name);
  if (!key) throw Error("there is no key '" + name + "'");
  gestures_.push_back([=](ImGuiIO& io) { io.KeyCtrl = with_ctrl, io.KeyShift = with_shift, io.KeysDown[*key] = true; });
  gestures_.push_back([=](ImGuiIO& io) { io.KeyCtrl = io.KeyShift = io.KeysDown[*key] = false; });
}

void UiScript::hold(const ScriptCommand& command) {
  const std::string& name = command.words[0];
  if (name == "shift") return gestures_.push_back([](ImGuiIO& io) { io.KeyShift = true; });
  if (name == "ctrl") return gestures_.push_back([](ImGuiIO& io) { io.KeyCtrl = true; });
  if (name == "alt") return gestures_.push_back([](ImGuiIO& io) { io.KeyAlt = true; });
  const auto key = key_number(name);
  if (!key) throw Error("there is no key '" + name + "'");
  gestures_.push_back([=](ImGuiIO& io) { io.KeysDown[*key] = true; });
}

void UiScript::release() {
  gestures_.push_back([](ImGuiIO& io) {
    io.KeyShift = io.KeyCtrl = io.KeyAlt = false;
    std::ranges::fill(io.KeysDown, false);
  });
}

void UiScript::before_frame(ScriptTarget& target) {
  if (!gestures_.empty()) {
    gestures_.front()(ImGui::GetIO());
    gestures_.pop_front();
    return;
  }
  if (next_ == commands_.size()) return;
  const ScriptCommand& command = commands_[next_];
  if (command.verb == "wait" && !is_reached(target, command)) return;
  ++next_;
  try {
    begin(target, command);
  } catch (const Error& error) {
    throw Error(path_ + ":" + std::to_string(command.line) + ": " + error.what());
  }
}

}  // namespace catchlight::app
