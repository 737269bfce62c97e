// Markers and sounds of a definition: codes, what they stand for, and the sentences of mistakes.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/base/definition/table.h"
#include "core/base/error.h"
#include "protocols/psychophysics/definition/read_definition.h"
#include "tests/protocols/psychophysics/definition/small_definition.h"
#include "tests/support/replaced.h"

namespace haptrial::protocols::markers_test {
namespace {

using testing::HasSubstr;

void read_marked(const std::string& text, TrialsDefinition& d) {
  Table root = Table::parse(text, "small.toml");
  root.leave("observer");
  read_trials_definition(root, "small.toml", d);
  check_markers(root, d);
  root.finish();
}

std::string problem(const std::string& text) {
  try {
    TrialsDefinition d;
    read_marked(text, d);
  } catch (const InputError& error) {
    return error.what();
  }
  return "none";
}

const std::string kBeep = R"([sounds.beep]
type = "tone"
frequency = 800.0
duration = 0.1
level = -20.0
)";

TEST(TrialMarkersTest, CodesCountOnWithinTheirKind) {
  TrialsDefinition d;
  read_marked(small_trials(kSmallStaircase, "[markers]\n"), d);
  EXPECT_EQ(markers::words_of(d.marker_meanings()),
            "trial 1, interval reference 11, interval comparison 12, stage press 21, "
            "response first 101, response second 102");
  EXPECT_THAT(d.description(),
              testing::Contains(HasSubstr("markers: trial 1, interval reference 11")))
      << "validate shows them";
}

TEST(TrialMarkersTest, AStageMayStateItsCode) {
  TrialsDefinition d;
  read_marked(test::replaced(small_trials(kSmallStaircase, ""), "name = \"press\"",
                             "name = \"press\"\nmarker = 17"),
              d);
  EXPECT_TRUE(d.markers.used) << "without [markers], too";
  EXPECT_THAT(markers::words_of(d.marker_meanings()), HasSubstr("stage press 17"));
}

TEST(TrialMarkersTest, WithoutMarkersThereAreNone) {
  TrialsDefinition d;
  read_marked(small_trials(kSmallStaircase, ""), d);
  EXPECT_FALSE(d.markers.used);
  EXPECT_EQ(d.sounds(), nullptr);
}

TEST(TrialMarkersTest, MistakesGetASentence) {
  const auto marked = [](const std::string& code) {
    return test::replaced(small_trials(kSmallStaircase, "[markers]\n"), "name = \"press\"",
                          "name = \"press\"\nmarker = " + code);
  };
  EXPECT_THAT(problem(marked("0")), HasSubstr("marker is 0; allowed: "));
  EXPECT_THAT(problem(marked("256")), HasSubstr("marker is 256"));
  EXPECT_THAT(problem(marked("12")),
              HasSubstr("give the code 12 two meanings, interval comparison and stage press"));
  EXPECT_THAT(problem(small_trials(kSmallStaircase, "[markers]\nresponse = 255\n")),
              HasSubstr("give response second the code 256"));
}

TEST(TrialMarkersTest, SoundsAreFoundByTheirNames) {
  TrialsDefinition d;
  read_marked(test::replaced(
                  small_trials(kSmallStaircase,
                               kBeep + "[display]\nsound_right = \"beep\"\n"
                                       "[sounds.masking]\nlevel = -40.0\nstages = [\"press\"]\n"),
                  "name = \"press\"", "name = \"press\"\nsound = \"beep\""),
              d);
  EXPECT_TRUE(d.markers.used) << "when a sound began is recorded";
  ASSERT_NE(d.sounds(), nullptr);
  EXPECT_EQ(d.sounds()->cues.at(0).name, "beep");
  EXPECT_EQ(d.sound_right, 0);
  EXPECT_EQ(d.sound_wrong, -1);
}

TEST(TrialMarkersTest, SoundsThatAreNotThereGetASentence) {
  const auto sounding = [](const std::string& name, const std::string& more) {
    return test::replaced(small_trials(kSmallStaircase, more), "name = \"press\"",
                          "name = \"press\"\nsound = \"" + name + "\"");
  };
  EXPECT_THAT(problem(sounding("chime", kBeep)), HasSubstr("a sound: beep"));
  EXPECT_THAT(problem(sounding("chime", "")), HasSubstr("the definition states none"));
  EXPECT_THAT(problem(small_trials(kSmallStaircase, kBeep + "[display]\nsound_wrong = \"buzz\"\n")),
              HasSubstr("a sound of [sounds]"));
  EXPECT_THAT(problem(small_trials(kSmallStaircase,
                                   "[sounds.masking]\nlevel = -40.0\nstages = [\"rest\"]\n")),
              HasSubstr("masking names the stage \"rest\"; allowed: press"));
}

}  // namespace
}  // namespace haptrial::protocols::markers_test
