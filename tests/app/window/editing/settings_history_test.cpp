#include "app/window/editing/settings_history.hpp"

#include <gtest/gtest.h>

namespace catchlight::app {
namespace {

SceneSettings with_yaw(double yaw_deg) {
  SceneSettings settings;
  settings.probe.yaw_deg = yaw_deg;
  return settings;
}

double yaw(const SettingsHistory& history) {
  return history.now().probe.yaw_deg;
}

TEST(SettingsHistory, GoesBackAndForth) {
  SettingsHistory history(with_yaw(0));
  EXPECT_FALSE(history.can_undo());
  for (const double yaw_deg : {1.0, 2.0, 3.0}) history.change(with_yaw(yaw_deg), "probe.yaw_deg"), history.end_gesture();
  history.undo(), history.undo();
  EXPECT_EQ(yaw(history), 1);
  history.redo();
  EXPECT_EQ(yaw(history), 2);
  history.change(with_yaw(9), "probe.yaw_deg");
  EXPECT_FALSE(history.can_redo()) << "what was undone is gone after another change";
  history.undo();
  EXPECT_EQ(yaw(history), 2);
}

TEST(SettingsHistory, ADraggedSliderIsOneStep) {
  SettingsHistory history(with_yaw(0));
  for (int i = 1; i <= 50; ++i) history.change(with_yaw(i), "probe.yaw_deg");
  history.end_gesture();
  EXPECT_EQ(yaw(history), 50);
  history.undo();
  EXPECT_EQ(yaw(history), 0);
}

TEST(SettingsHistory, AnotherKeyIsAnotherStep) {
  SettingsHistory history(with_yaw(0));
  history.change(with_yaw(1), "probe.yaw_deg");
  history.change(with_yaw(2), "probe.ev");
  history.undo();
  EXPECT_EQ(yaw(history), 1);
}

TEST(SettingsHistory, KnowsWhetherItIsSaved) {
  SettingsHistory history(with_yaw(0));
  EXPECT_TRUE(history.is_saved());
  history.change(with_yaw(1), "probe.yaw_deg");
  EXPECT_FALSE(history.is_saved());
  history.undo();
  EXPECT_TRUE(history.is_saved());
  history.redo();
  history.mark_saved();
  EXPECT_EQ(history.file().probe.yaw_deg, 1);
  history.undo();
  EXPECT_FALSE(history.is_saved());
  history.change(with_yaw(5), "probe.yaw_deg");
  EXPECT_FALSE(history.is_saved()) << "the saved step was left behind";
  history.undo();
  EXPECT_FALSE(history.is_saved());
}

TEST(SettingsHistory, AfterSavingTheSameSliderBeginsANewStep) {
  SettingsHistory history(with_yaw(0));
  history.change(with_yaw(1), "probe.yaw_deg");
  history.mark_saved();
  history.change(with_yaw(2), "probe.yaw_deg");
  EXPECT_FALSE(history.is_saved());
  history.undo();
  EXPECT_EQ(yaw(history), 1);
  EXPECT_TRUE(history.is_saved());
}

TEST(SettingsHistory, FlipsBetweenTwo) {
  SettingsHistory history(with_yaw(0));
  history.keep(0);
  history.take(1);
  EXPECT_FALSE(history.can_undo()) << "nothing was kept there";
  history.change(with_yaw(7), "probe.yaw_deg");
  history.keep(1);
  history.take(0);
  EXPECT_EQ(yaw(history), 0);
  history.take(1);
  EXPECT_EQ(yaw(history), 7);
  history.undo();
  EXPECT_EQ(yaw(history), 0);
}

}  // namespace
}  // namespace catchlight::app
