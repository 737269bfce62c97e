// Values that only a later group, session, participant, trial, probe or combination of factors
// would present are checked before anybody comes.

#include "protocols/psychophysics/definition/every_value.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/protocols/psychophysics/definition/small_definition.h"
#include "tests/support/replaced.h"

namespace haptrial::protocols::every_value_test {
namespace {

using testing::Contains;
using testing::HasSubstr;
using testing::IsEmpty;

/// A constant push of `$f`, which a field may give up to 3 N. @param more  what gives f its value
std::string pushed(const std::string& more, const std::string& design = "participants = 4") {
  std::string text = test::replaced(small_trials("", more), "participants = 4", design);
  text = test::replaced(text, "fields = [\"floor\"]", "fields = [\"push\"]");
  text = test::replaced(text, "comparison = { stiffness = \"$level\" }",
                        "comparison = { stiffness = 310.0 }");
  return text + "[fields.push]\ntype = \"constant\"\nforce = [\"$f\", 0.0, 0.0]\nlimit = 3.0\n";
}

const std::string kBlock = "[[blocks]]\nname = \"a\"\ntrials = 4\n";

void expect_refused(const std::string& text, const std::string& with) {
  const auto problems = problems_of_trials(text);
  EXPECT_THAT(problems, Contains(HasSubstr("fields.push asks for")));
  EXPECT_THAT(problems, Contains(HasSubstr(with)));
}

TEST(EveryValueTest, TheValuesOfEveryGroup) {
  const auto of = [](const std::string& weak, const std::string& strong) {
    return pushed("[variables]\nf = { from = \"group\", weak = " + weak + ", strong = " + strong +
                  " }\n[groups]\nweak = 2\nstrong = 2\n" + kBlock);
  };
  EXPECT_THAT(problems_of_trials(of("2.0", "2.5")), IsEmpty());
  expect_refused(of("2.0", "6.0"), "group strong");
  expect_refused(of("6.0", "2.0"), "group weak");
}

TEST(EveryValueTest, TheValuesOfEverySessionParticipantAndTrial) {
  EXPECT_THAT(problems_of_trials(pushed("[variables]\nf = \"0.7 * $participant\"\n" + kBlock)),
              IsEmpty());
  expect_refused(pushed("[variables]\nf = \"0.8 * $participant\"\n" + kBlock), "participant 4");
  expect_refused(pushed("[variables]\nf = \"0.8 * $trial\"\n" + kBlock), "trial 4");
  const std::string two = "participants = 4\nsessions = 2";
  EXPECT_THAT(problems_of_trials(pushed("[variables]\nf = \"1.5 * $session\"\n" + kBlock, two)),
              IsEmpty());
  expect_refused(pushed("[variables]\nf = \"1.6 * $session\"\n" + kBlock, two), "session 2");
}

TEST(EveryValueTest, TheValuesOfAProbe) {
  const std::string block = "[variables]\nf = 1.0\n" + kBlock;
  EXPECT_THAT(problems_of_trials(pushed(block + "probe = { share = 0.25, f = 2.0 }\n")), IsEmpty());
  expect_refused(pushed(block + "probe = { share = 0.25, f = 4.0 }\n"), "with the probe");
}

std::string levels(int count, double last) {
  std::string text = "[";
  for (int i = 1; i < count; ++i) {
    text += std::to_string(i) + ".0e-3, ";
  }
  return text + std::to_string(last) + "]";
}

TEST(EveryValueTest, TheLastLevelOfManyFactors) {
  const auto with = [](int count, double last) {
    return pushed("[factors]\na = " + levels(count, 1.0) + "\nb = " + levels(count, 1.0) +
                  "\nf = " + levels(count, last) + "\n" + kBlock);
  };
  expect_refused(with(12, 4.0), "f = 4");
  expect_refused(with(40, 4.0), "f = 4");  // of 64,000 combinations not all are tried
  TrialsDefinition d;
  read_small(with(40, 2.0), d);
  EXPECT_THAT(check_every_value(d).warnings,
              Contains(HasSubstr("block a has 128000 combinations of values, of which 4096 were "
                                 "checked, each value in some")));
}

/// Each session finds a threshold in one block, and uses it in another.
std::string found_and_used(const std::string& sessions, const std::string& used) {
  return pushed(
      "[variables]\nf = 1.0\n"
      "[[procedures]]\n[[procedures.tracks]]\nname = \"stair\"\nkind = \"staircase\"\n"
      "variable = \"f\"\nrange = [0.5, 2.0]\nstart = 1.5\nsteps = [0.2]\n"
      "stop = { reversals = 4, trials = 20 }\n"
      "estimate = { of = \"mean of reversals\" }\n"
      "[[blocks]]\nname = \"find\"\nprocedures = [\"stair\"]\n"
      "[[blocks]]\nname = \"use\"\ntrials = 4\nf = \"" +
          used + "\"\n" + sessions,
      "participants = 4\nsessions = 2");
}

TEST(EveryValueTest, BlocksComeInTheOrderOfTheirSession) {
  const auto in_order = [](const std::string& first) {
    return "[design.session.1]\nblocks = [" + first +
           "]\n[design.session.2]\nblocks = [\"find\", \"use\"]\n";
  };
  const std::string used = "$stair.threshold";
  EXPECT_THAT(problems_of_trials(found_and_used(in_order("\"find\", \"use\""), used)), IsEmpty());
  EXPECT_THAT(problems_of_trials(found_and_used(in_order("\"use\", \"find\""), used)),
              Contains(HasSubstr("block use uses $stair.threshold, but in session 1 no block "
                                 "before it asks that procedure")));
}

/// In a formula each name may stand without its "$".
TEST(EveryValueTest, ANeededThresholdIsKnownByItsFormula) {
  TrialsDefinition d;
  read_small(found_and_used("", "$session * 0.0 + stair.threshold"), d);
  check_every_value(d);
  EXPECT_THAT(d.order.blocks[1].needs, testing::ElementsAre("stair"));
}

/// The first level of a factor may do without a threshold that another one needs.
TEST(EveryValueTest, AThresholdThatOneLevelNeedsIsKnown) {
  std::string text = found_and_used("[factors]\nfound = [1.0, \"$stair.threshold\"]\n", "$session");
  text = test::replaced(text, "[\"$f\", 0.0, 0.0]", "[\"$f\", \"0.1 * $found\", 0.0]");
  text = test::replaced(text, "procedures = [\"stair\"]\n[[blocks]]",
                        "procedures = [\"stair\"]\nfound = 1.0\n[[blocks]]");
  TrialsDefinition d;
  read_small(text, d);
  check_every_value(d);
  EXPECT_THAT(d.order.blocks[1].needs, testing::ElementsAre("stair"));
}

}  // namespace
}  // namespace haptrial::protocols::every_value_test
