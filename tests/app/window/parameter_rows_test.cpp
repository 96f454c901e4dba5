// Every row of the parameter table, in the window: found, turned, saved, read back, and brought back by undo.
#include "app/settings/change_cost.hpp"
#include "app/settings/parameters.hpp"
#include "app/settings/scene_file.hpp"
#include "catchlight/util/text.hpp"
#include "tests/app/window/driven_window.hpp"

#include <gmock/gmock.h>

#include <cmath>

namespace catchlight::app::testing {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

using WindowParameters = WindowTest;

/// What a hand does with a parameter's control, after the search has found it: a script's lines.
struct ByHand {
  const std::string& key;
  const std::string held;

  std::string drag() const { return "drag " + key + " 0.06 0.26\n"; }
  std::string enter(const std::string& text) const { return "click " + key + "\nkey ctrl+a\ntype " + text + "\nkey enter\n"; }
  std::string choose(const std::vector<std::string>& choices) const {
    for (const std::string& choice : choices)
      if (choice != held) return "click " + key + "\nclick " + key + ' ' + choice + '\n';
    return "";
  }

  std::string operator()(const RealKind&) const { return "drag " + key + " 0.4 0.6\n"; }
  std::string operator()(const IntegerKind& kind) const {
    const bool is_slider = kind.max - kind.min < 1000 || kind.scale == Scale::logarithmic;
    return is_slider ? "drag " + key + " 0.4 0.6\n" : enter("77");
  }
  std::string operator()(const VectorKind&) const { return drag(); }
  std::string operator()(const FlagKind&) const { return "click " + key + '\n'; }
  std::string operator()(const SwitchKind&) const { return choose({"auto", "off", "on"}); }
  std::string operator()(const PathKind&) const { return enter("other.file"); }
  std::string operator()(const WordKind& kind) const { return choose(kind.choices); }
  std::string operator()(const ChoiceKind& kind) const { return choose(kind.choices); }
};

/// Another value that `set` takes.
struct Other {
  std::string held;

  std::string operator()(const RealKind& kind) const {
    const double value = std::stod(held), end = std::abs(kind.max) < 1000 ? kind.max : 100;
    return number_text(value == end ? kind.min : 0.75 * value + 0.25 * end);
  }
  std::string operator()(const IntegerKind& kind) const {
    const int value = std::stoi(held);
    return std::to_string(value < kind.max ? value + 1 : value - 1);
  }
  std::string operator()(const VectorKind&) const { return "0.25,0.5,0.75"; }
  std::string operator()(const FlagKind&) const { return held == "true" ? "false" : "true"; }
  std::string operator()(const SwitchKind&) const { return "false"; }
  std::string operator()(const PathKind&) const { return "/somewhere/file"; }
  std::string operator()(const WordKind& kind) const {
    return kind.choices.back() == held ? kind.choices.front() : kind.choices.back();
  }
  std::string operator()(const ChoiceKind& kind) const { return kind.choices.back(); }
};

/// The window's settings as a scene file has them.
SceneSettings saved(DrivenWindow& driven, const std::string& path) {
  driven.window().save(path);
  return read_scene_file(path);
}

/// Keys whose values differ.
std::vector<std::string> changed_keys(const SceneSettings& before, const SceneSettings& after) {
  std::vector<std::string> keys;
  for (const Parameter& parameter : parameters())
    if (parameter_text(before, parameter) != parameter_text(after, parameter)) keys.push_back(parameter.key);
  return keys;
}

class TurnedParameter {
 public:
  TurnedParameter(DrivenWindow& driven, const Parameter& parameter, const std::string& scene, const std::string& copy)
      : driven_(driven), parameter_(parameter), copy_(copy), text_(tests::read_text(scene)), before_(read_scene_file(scene)) {}

  /// After the change: the row alone has changed, the file says so, and it costs what the table says.
  void expect_changed() {
    const std::string value = driven_.window().value_of(parameter_.key);
    const SceneSettings after = saved(driven_, copy_);
    EXPECT_THAT(changed_keys(before_, after), ElementsAre(parameter_.key));
    EXPECT_EQ(parameter_text(after, parameter_), value) << "read back";
    EXPECT_THAT(costs_of_change(before_, after), ElementsAre(parameter_.cost));
  }

  void expect_as_before() {
    EXPECT_EQ(driven_.window().value_of(parameter_.key), parameter_text(before_, parameter_));
    saved(driven_, copy_);
    EXPECT_EQ(tests::read_text(copy_), text_) << "to the byte";
  }

 private:
  DrivenWindow& driven_;
  const Parameter& parameter_;
  std::string copy_, text_;
  SceneSettings before_;
};

TEST_F(WindowParameters, EachIsFoundTurnedSavedAndBroughtBack) {
  DrivenWindow driven(path(""));
  for (const Parameter& parameter : parameters()) {
    SCOPED_TRACE(parameter.key);
    driven.run("click search\nkey ctrl+a\ntype " + parameter.key + '\n');
    driven.draw(1);
    ASSERT_TRUE(driven.window().items().find(parameter.key)) << "there is a control";
    const std::string held = driven.window().value_of(parameter.key);
    TurnedParameter turned(driven, parameter, path("scene.toml"), path("copy.toml"));
    const std::string hand = std::visit(ByHand{parameter.key, held}, parameter.kind);
    if (hand.empty()) {
      EXPECT_EQ(parameter.key, "object.shading") << "has one value only";
      continue;
    }
    driven.run(hand);
    turned.expect_changed();
    driven.run("click undo\n");
    turned.expect_as_before();
    const std::string other = std::visit(Other{held}, parameter.kind);
    driven.run("set " + parameter.key + ' ' + other + '\n');
    EXPECT_EQ(driven.window().value_of(parameter.key), other);
    turned.expect_changed();
    driven.run("click undo\n");
    turned.expect_as_before();
  }
}

}  // namespace
}  // namespace catchlight::app::testing
