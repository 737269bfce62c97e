#include "core/render/flat/trial_display_style.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <stdexcept>
#include <string>

#include "core/base/error.h"

namespace haptrial::render {
namespace {

using testing::AllOf;
using testing::HasSubstr;

TrialDisplayStyle read(const std::string& lines) {
  Table document = Table::parse("[display]\n" + lines, "look.toml");
  Table display = document.table("display");
  const TrialDisplayStyle style = trial_display_schema().read(display);
  document.finish();
  return style;
}

std::string problem(const std::string& lines) {
  try {
    read(lines);
  } catch (const InputError& error) {
    return error.what();
  }
  return "nothing was thrown";
}

TEST(ParseColourTest, ReadsSixHexadecimalDigits) {
  EXPECT_EQ(parse_colour("#ff0033"), (Colour{1.0, 0.0, 0.2}));
  EXPECT_EQ(parse_colour("#AbCdEf"), parse_colour("#abcdef"));
  for (const char* text : {"", "#", "ff0033", "#ff003", "#ff00333", "#ff00g3", "#-f0033", "# f0033",
                           "#+f0033", "red", "#0x0033"}) {
    EXPECT_FALSE(parse_colour(text)) << text;
  }
}

TEST(TrialDisplayStyleTest, AbsentKeysKeepTheirDefaults) {
  const TrialDisplayStyle defaults;
  const TrialDisplayStyle style = read("full_scale = 8\n");
  EXPECT_EQ(style.full_scale, 8.0);
  EXPECT_EQ(style.width, defaults.width);
  EXPECT_EQ(style.background, defaults.background);
  EXPECT_NO_THROW(check(defaults));
}

TEST(TrialDisplayStyleTest, EveryKeyReachesItsValue) {
  const TrialDisplayStyle style = read(R"(
width = 800
height = 600
margin = 0
trajectory_width = 2.5
marker_radius = 7
full_scale = 10.5
bar_width = 12
bar_height = 90
bar_gap = 0
saturation_size = 9
background = "#010000"
trajectory_colour = "#020000"
marker_colour = "#030000"
target_colour = "#040000"
applied_colour = "#050000"
saturation_colour = "#060000"
)");
  EXPECT_EQ(style.width, 800);
  EXPECT_EQ(style.height, 600);
  EXPECT_EQ(style.margin, 0.0);
  EXPECT_EQ(style.trajectory_width, 2.5);
  EXPECT_EQ(style.marker_radius, 7.0);
  EXPECT_EQ(style.full_scale, 10.5);
  EXPECT_EQ(style.bar_width, 12.0);
  EXPECT_EQ(style.bar_height, 90.0);
  EXPECT_EQ(style.bar_gap, 0.0);
  EXPECT_EQ(style.saturation_size, 9.0);
  EXPECT_DOUBLE_EQ(style.background.red * 255.0, 1.0);
  EXPECT_DOUBLE_EQ(style.trajectory_colour.red * 255.0, 2.0);
  EXPECT_DOUBLE_EQ(style.marker_colour.red * 255.0, 3.0);
  EXPECT_DOUBLE_EQ(style.target_colour.red * 255.0, 4.0);
  EXPECT_DOUBLE_EQ(style.applied_colour.red * 255.0, 5.0);
  EXPECT_DOUBLE_EQ(style.saturation_colour.red * 255.0, 6.0);
}

TEST(TrialDisplayStyleTest, BadValuesAreNamedWithTheirLine) {
  EXPECT_THAT(problem("width = 1280\ntarget_colour = \"blue\"\n"),
              AllOf(HasSubstr("look.toml:3"), HasSubstr("display.target_colour"),
                    HasSubstr("'blue'"), HasSubstr("#rrggbb")));
  EXPECT_THAT(problem("background = 7\n"), HasSubstr("display.background"));
  EXPECT_THAT(problem("full_scale = 0\n"), AllOf(HasSubstr("full_scale"), HasSubstr("N")));
  EXPECT_THAT(problem("width = 10\n"), HasSubstr("display.width"));
  EXPECT_THAT(problem("bar_width = -1\n"), HasSubstr("display.bar_width"));
  EXPECT_THAT(problem("bar_with = 12\n"), HasSubstr("bar_with"));
}

TEST(TrialDisplayStyleTest, BarsThatLeaveNoRoomAreRejected) {
  EXPECT_THAT(problem("height = 200\n"), AllOf(HasSubstr("look.toml:2"), HasSubstr("200 px")));
  EXPECT_THAT(problem("margin = 700\n"), HasSubstr("700 px"));
  EXPECT_THAT(problem("width = 160\n"), HasSubstr("160 px"));
}

void expect_rejected(void (*break_it)(TrialDisplayStyle&), const std::string& name) {
  TrialDisplayStyle style;
  break_it(style);
  try {
    check(style);
    ADD_FAILURE() << name << " was accepted";
  } catch (const std::invalid_argument& error) {
    EXPECT_THAT(error.what(), HasSubstr(name));
  }
}

TEST(TrialDisplayStyleTest, CheckNamesTheValueThatBreaksItsBound) {
  expect_rejected([](TrialDisplayStyle& s) { s.full_scale = 0.0; }, "full_scale");
  expect_rejected([](TrialDisplayStyle& s) { s.bar_height = -1.0; }, "bar_height");
  expect_rejected([](TrialDisplayStyle& s) { s.smallest_extent = 0.0; }, "smallest_extent");
  expect_rejected([](TrialDisplayStyle& s) { s.margin = std::nan(""); }, "margin");
  expect_rejected([](TrialDisplayStyle& s) { s.frame_opacity = 1.1; }, "frame_opacity");
  expect_rejected([](TrialDisplayStyle& s) { s.bar_divisions = 0; }, "bar_divisions");
  expect_rejected([](TrialDisplayStyle& s) { s.height = 100; }, "no room");
}

}  // namespace
}  // namespace haptrial::render
