#include "protocols/psychophysics/definition/read_stages.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <sstream>

#include "core/base/definition/table.h"
#include "core/base/error.h"
#include "core/base/random.h"

namespace haptrial::protocols {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

StageSource source() { return {{"guide", "floor"}, {"start"}, nullptr, nullptr}; }

/// The stages of a text; what is wrong with it goes to `problems`.
std::vector<NamedStage> stages_of(const std::string& text, std::vector<std::string>& problems,
                                  const StageSource& from = source()) {
  Table root = Table::parse(text, "f.toml");
  std::vector<NamedStage> stages = read_stages(root, from);
  try {
    root.finish();
  } catch (const InputError& error) {
    std::istringstream in(error.what());
    for (std::string line; std::getline(in, line);) {
      problems.push_back(line);
    }
  }
  return stages;
}

std::vector<std::string> problems_of(const std::string& text) {
  std::vector<std::string> problems;
  stages_of(text, problems);
  return problems;
}

TEST(ReadStagesTest, AsAnExperimenterWritesThem) {
  std::vector<std::string> problems;
  const auto stages = stages_of(R"([[stages]]
name = "approach"
fields = ["guide"]
show = ["hand"]
until = { inside = "start", for = 0.3 }
timeout = { after = 5.0, then = "abort" }
[[stages]]
name = "press"
fields = ["floor", "guide"]
until = { time = 2.5 }
require = { max_of = "depth", field = "floor", at_least = 0.005, else = "repeat" }
onset = { speed_above = 0.03 }
)",
                                problems);
  EXPECT_THAT(problems, ElementsAre());
  ASSERT_EQ(stages.size(), 2U);
  EXPECT_EQ(stages[0].stage.fields, 0b01U);
  EXPECT_EQ(stages[0].stage.until.inside, 0b1U);
  EXPECT_EQ(stages[0].stage.until.hold, 0.3);
  EXPECT_EQ(stages[0].stage.timeout, 5.0);
  EXPECT_EQ(stages[0].stage.late, Consequence::kAbort);
  EXPECT_THAT(stages[0].show, ElementsAre("hand"));
  EXPECT_EQ(stages[1].stage.fields, 0b11U);
  EXPECT_EQ(stages[1].stage.until.time, 2.5);
  ASSERT_TRUE(stages[1].stage.require);
  EXPECT_EQ(stages[1].stage.require->field, 1);
  EXPECT_EQ(stages[1].stage.require->at_least, 0.005);
  EXPECT_EQ(stages[1].stage.require->otherwise, Consequence::kRepeat);
  EXPECT_EQ(stages[1].stage.onset_speed, 0.03);
}

TEST(ReadStagesTest, ADurationIsDrawnBetweenItsEnds) {
  const std::string text =
      "[[stages]]\nname = \"hold\"\nuntil = { inside = \"start\", for = [0.5, 1.0] }\n"
      "timeout = { after = 9.0, then = \"abort\" }\n";
  RandomStream random(1, "durations");
  StageSource drawn = source();
  drawn.random = &random;
  double least = 9.0;
  double most = 0.0;
  double sum = 0.0;
  constexpr int kDrawn = 400;
  for (int k = 0; k < kDrawn; ++k) {
    std::vector<std::string> problems;
    const double hold = stages_of(text, problems, drawn)[0].stage.until.hold;
    least = std::min(least, hold);
    most = std::max(most, hold);
    sum += hold;
  }
  EXPECT_GE(least, 0.5);
  EXPECT_LT(most, 1.0);
  EXPECT_NEAR(sum / kDrawn, 0.75, 5.0 * 0.5 / std::sqrt(12.0 * kDrawn));
}

TEST(ReadStagesTest, AWordOfTheBlockNamesItsField) {
  const std::string text =
      "[[stages]]\nname = \"reach\"\nfields = [\"guide\", \"$field\"]\nuntil = { time = 1.0 }\n";
  for (const auto& [word, mask] :
       std::vector<std::pair<std::string, std::uint64_t>>{{"floor", 0b11}, {"null", 0b01}}) {
    StageSource with = source();
    with.word = [&](const std::string& name) { return name == "$field" ? word : name; };
    std::vector<std::string> problems;
    EXPECT_EQ(stages_of(text, problems, with)[0].stage.fields, mask);
    EXPECT_THAT(problems, ElementsAre());
  }
}

TEST(ReadStagesTest, AStageMayWaitForAChannel) {
  StageSource with = source();
  with.values = {"grip.force", "grip.angle"};
  const std::string head = "[[stages]]\nname = \"a\"\nuntil = { channel = \"";
  const std::string end = " }\ntimeout = { after = 5.0, then = \"abort\" }\n";
  std::vector<std::string> problems;
  const Until until =
      stages_of(head + "grip.angle\", above = 2.0" + end, problems, with)[0].stage.until;
  EXPECT_THAT(problems, ElementsAre());
  EXPECT_EQ(until.channel, 1u);
  EXPECT_EQ(until.above, 2.0);
  const auto problem = [&](const std::string& keys) {
    std::vector<std::string> found;
    stages_of(head + keys + end, found, with);
    return found;
  };
  EXPECT_THAT(problem("grap\", above = 2.0"),
              ElementsAre("f.toml:3: stages[1].until.channel is \"grap\"; allowed: a value "
                          "of a channel: grip.force, grip.angle"));
  EXPECT_THAT(problem("grip\""),
              ElementsAre(HasSubstr("stands without a value; add above or below")));
  EXPECT_THAT(problem("grip\", above = 2.0, below = 1.0"),
              ElementsAre(HasSubstr("above is 2; allowed: less than below, 1")));
}

TEST(ReadStagesTest, MistakesGetTheirSentence) {
  const std::string head = "[[stages]]\nname = \"a\"\n";
  EXPECT_THAT(problems_of(head + "until = { inside = \"start\" }\n"),
              ElementsAre("f.toml:3: stages[1].until may never come; add timeout = { after = …, "
                          "then = \"abort\" }"));
  EXPECT_THAT(problems_of(head + "until = {}\n"),
              ElementsAre(HasSubstr("stages[1].until names no end of the stage")));
  EXPECT_THAT(problems_of(head + "fields = [\"flor\"]\nuntil = { time = 1.0 }\n"),
              ElementsAre("f.toml:3: stages[1].fields is \"flor\"; allowed: a field: guide, "
                          "floor"));
  EXPECT_THAT(problems_of(head + "until = { time = 1.0, for = [2.0, 1.0] }\n"),
              ElementsAre(HasSubstr("for is [2, 1]; allowed: a time or [shortest, longest] [s]")));
  const std::string abort = ", then = \"abort\" }\n";
  EXPECT_THAT(problems_of(head + "until = { time = 0.5 }\ntimeout = { after = 0.05" + abort),
              ElementsAre(HasSubstr("stages[1].timeout.after is 0.05, before the stage can end; "
                                    "allowed: at least the 0.5 s that until takes")));
  EXPECT_THAT(problems_of(head +
                          "until = { inside = \"start\", for = [0.1, 0.7] }\n"
                          "timeout = { after = 0.6" +
                          abort),
              ElementsAre(HasSubstr("at least the 0.7 s that until takes")))
      << "or trials of a long drawn time would abort for ever";
  EXPECT_THAT(
      problems_of(head + "until = { time = 0.5, for = 0.5 }\ntimeout = { after = 0.9" + abort),
      ElementsAre(HasSubstr("at least the 1 s that until takes")));
  EXPECT_THAT(
      problems_of(head + "until = { time = 0.5, for = 0.5 }\ntimeout = { after = 1.0" + abort),
      ElementsAre());
  EXPECT_THAT(problems_of(head +
                          "until = { speed_above = 0.2, speed_below = 0.1 }\n"
                          "timeout = { after = 2.0" +
                          abort),
              ElementsAre(HasSubstr("until.speed_above is 0.2 [m/s]; allowed: less than "
                                    "speed_below, 0.1 [m/s]")));
  EXPECT_THAT(problems_of(head + "until = { time = 1.0 }\n" + head + "until = { time = 1.0 }\n"),
              ElementsAre(HasSubstr("stages[2].name is \"a\"; allowed: a name that no other stage "
                                    "has")));
  EXPECT_THAT(problems_of(head + "until = { time = 1.0 }\nuntill = 3\n"),
              ElementsAre(HasSubstr("stages[1].untill is not a known key")));
  EXPECT_THAT(problems_of(head + "until = { time = 1.0 }\nrequire = { max_of = \"depth\", field = "
                                 "\"floor\", at_least = 0.01, else = \"wait\" }\n"),
              ElementsAre(HasSubstr("else is 'wait'; allowed: abort, repeat, go on")));
}

}  // namespace
}  // namespace haptrial::protocols
