#include "protocols/definition/button_uses.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "core/device/vendor_devices.h"
#include "protocols/psychophysics/definition/trials_definition.h"
#include "tests/protocols/psychophysics/definition/small_definition.h"

namespace haptrial::protocols {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

constexpr const char* kHaply =
    "[haply]\nmax_force = 3.5\nworkspace_radius = 0.1\npatience = 0.018\nstop_button = ";

/// Warnings of a small definition with these lines, two choices of which have the buttons 0 and 1.
std::vector<std::string> warnings(const std::string& more,
                                  const std::vector<std::string>& devices = {},
                                  const std::string& until = "time = 0.2") {
  std::string text = small_trials(kSmallStaircase, more);
  const std::string given = "until = { time = 0.2 }";
  text.replace(text.find(given), given.size(),
               "until = { " + until + " }\ntimeout = { after = 9.0, then = \"abort\" }");
  TrialsDefinition definition;
  read_small(text, definition);
  return button_warnings(definition, devices);
}

TEST(ButtonUsesTest, AStopButtonThatAnswersIsNamedWithBothKeys) {
  EXPECT_THAT(warnings(""), IsEmpty());
  EXPECT_THAT(warnings(std::string(kHaply) + "2\n"), IsEmpty());
  EXPECT_THAT(warnings(std::string(kHaply) + "-1\n"), IsEmpty());
  EXPECT_THAT(warnings(std::string(kHaply) + "1\n"),
              ElementsAre("haply.stop_button is 1, and response.choices[2].buttons takes button 1, "
                          "too, so that who presses it stops the session; give one of them another "
                          "button"));
}

TEST(ButtonUsesTest, AStopButtonThatEndsAStageIsNamed) {
  EXPECT_THAT(warnings(std::string(kHaply) + "2\n", {}, "buttons = [2, 3]"),
              ElementsAre(AllOf(HasSubstr("haply.stop_button is 2"),
                                HasSubstr("stages[1].until.buttons takes button 2"))));
}

TEST(ButtonUsesTest, ASessionKnowsTheDefaultsOfItsDevices) {
  EXPECT_THAT(warnings("", {"virtual"}), IsEmpty());
  EXPECT_THAT(warnings("", {"haply"}), IsEmpty());  // 2
  EXPECT_THAT(warnings("", {"force-dimension"}),
              ElementsAre(AllOf(HasSubstr("force_dimension.stop_button is 0 by default"),
                                HasSubstr("response.choices[1].buttons"))));
  EXPECT_THAT(warnings("", {"virtual", "mouse"}),
              ElementsAre(HasSubstr("mouse.stop_button is 1 by default")));
  EXPECT_THAT(warnings(std::string(kHaply) + "1\n", {"virtual"}), IsEmpty());
}

TEST(ButtonUsesTest, AButtonThatPausesAPlaybackAndEndsAStageIsNamed) {
  const std::string pause = "[tutoring]\npause_buttons = [0, 2]\n";
  EXPECT_THAT(warnings(pause), IsEmpty());  // nothing is played while the question is asked
  EXPECT_THAT(warnings(pause, {}, "buttons = [2]"),
              ElementsAre("stages[1].until.buttons and tutoring.pause_buttons both take button 2, "
                          "so that one press does both; give one of them another button"));
  EXPECT_THAT(warnings(pause + kHaply + "2\n").size(), 1u);
}

/// A button may end a stage and answer the question after it.
TEST(ButtonUsesTest, WhatIsNotHeardAtTheSameTimeMayShareAButton) {
  EXPECT_THAT(warnings("", {}, "buttons = [0]"), IsEmpty());
}

/// The list of stop buttons has every maker's device that has one: a driver whose stop button can
/// be freed.
TEST(ButtonUsesTest, EveryStopButtonIsKnown) {
  for (const device::VendorDevice& vendor : device::vendor_devices()) {
    TrialsDefinition d;
    d.vendor.force_dimension.stop_button = d.vendor.open_haptics.stop_button = 3;
    d.vendor.haply.stop_button = d.vendor.paddle.stop_button = 3;
    const auto before = stop_button_of(d, vendor.name);
    EXPECT_EQ(before.has_value(), std::string(vendor.name) != "hapi") << vendor.name;
    if (before) {
      EXPECT_EQ(before->key, fmt::format("{}.stop_button", vendor.table));
      EXPECT_EQ(before->button, 3) << vendor.name;
      vendor.free_stop_button(d.vendor);
      EXPECT_EQ(stop_button_of(d, vendor.name)->button, -1) << vendor.name;
    }
  }
}

}  // namespace
}  // namespace haptrial::protocols
