#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <bit>

#include "protocols/definition/window_keys.h"
#include "protocols/psychophysics/definition/every_value.h"
#include "tests/protocols/psychophysics/definition/small_definition.h"
#include "tests/support/replaced.h"

namespace haptrial::protocols::mistakes_test {
namespace {

using testing::AllOf;
using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

const std::string kSmall = small_trials(kSmallStaircase);

TEST(TrialMistakesTest, AGoodDefinitionHasNone) {
  EXPECT_THAT(problems_of_trials(kSmall), IsEmpty());
}

TEST(TrialMistakesTest, UnknownVariable) {
  EXPECT_THAT(problems_of_trials(test::replaced(kSmall, "stiffness = \"$stiffness\"",
                                                "stiffness = \"$stifness\"")),
              Contains(AllOf(HasSubstr("small.toml:10: fields.floor.stiffness is \"$stifness\""),
                             HasSubstr("there is no variable stifness; allowed: "))));
  EXPECT_THAT(problems_of_trials(
                  test::replaced(kSmall, "stiffness = \"$level\"", "stiffness = \"$lvl + 1\"")),
              Contains(HasSubstr("no variable lvl")));
}

TEST(TrialMistakesTest, AStartIsComparedWithARangeThatIsOne) {
  EXPECT_THAT(
      problems_of_trials(
          test::replaced(kSmall, "range = [310.0, 600.0]", "range = [610.0, 900.0]")),
      ElementsAre(HasSubstr("start is 500; allowed: a number within the range, 610 to 900")));
  EXPECT_THAT(problems_of_trials(
                  test::replaced(kSmall, "range = [310.0, 600.0]", "range = [600.0, 310.0]")),
              ElementsAre(HasSubstr("range is another list; allowed: [lowest, highest]")));
}

TEST(TrialMistakesTest, OfAnUnknownProcedureNothingElseIsSaid) {
  EXPECT_THAT(
      problems_of_trials(test::replaced(kSmall, "kind = \"staircase\"", "kind = \"stairs\"")),
      ElementsAre(HasSubstr("procedure.kind is 'stairs'; allowed: staircase, limits, pest")));
  EXPECT_THAT(problems_of_trials(test::replaced(kSmall, "kind = \"staircase\"\n", "")),
              ElementsAre(HasSubstr("procedure.kind is missing")));
}

TEST(TrialMistakesTest, WithoutBlocksNoStageIsCalledUnknown) {
  const std::string stages = "[[stages]]\nname = \"rest\"\nuntil = { time = 0.1 }\n";
  const std::string head =
      "[experiment]\nprotocol = \"trials\"\nname = \"t\"\n[design]\nparticipants = 2\n";
  EXPECT_THAT(problems_of_trials(head + "[[block]]\nname = \"main\"\ntrials = 1\n" + stages),
              ElementsAre(HasSubstr("block is not a known key; did you mean blocks?")));
  EXPECT_THAT(problems_of_trials(head + stages),
              ElementsAre(HasSubstr("design has nothing to present; add a [procedure] or "
                                    "[[blocks]]")));
}

TEST(TrialMistakesTest, MistakesOfFormulas) {
  EXPECT_THAT(problems_of_trials(test::replaced(kSmall, "\"$stiffness\"", "\"$stiffness * (2\"")),
              Contains(HasSubstr("fields.floor.stiffness is \"$stiffness * (2\"")));
  EXPECT_THAT(
      problems_of_trials(small_trials(kSmallStaircase, "[variables]\na = \"$b\"\nb = \"$a\"\n")),
      Contains(AllOf(HasSubstr("variables.a"), HasSubstr("depends on itself"))));
}

TEST(TrialMistakesTest, ALevelIsAsLongAsAFileHasRoomFor) {
  const auto problems = [](std::size_t bytes) {
    return problems_of_trials(small_trials(
        kSmallStaircase, "[factors]\ntool = [\"" + std::string(bytes, 'x') + "\", \"needle\"]\n"));
  };
  EXPECT_THAT(problems(64), IsEmpty());
  EXPECT_THAT(problems(65), Contains(HasSubstr("allowed: words of at most 64 bytes")));
}

TEST(TrialMistakesTest, ATrackHasRoomForItsLevels) {
  const std::string factors = R"([factors]
material = ["soft silicone with a rough coating", "hard acrylic"]
tool = ["short needle", "steel needle"]
)";
  const std::string by =
      test::replaced(kSmallStaircase, "range", "by = [\"material\", \"tool\"]\nrange");
  EXPECT_THAT(problems_of_trials(small_trials(by, factors)), IsEmpty());
  const std::string longer =
      test::replaced(factors, "short needle", "short needle with a bevelled tip");
  EXPECT_THAT(problems_of_trials(small_trials(by, longer)),
              Contains(HasSubstr("short needle with a bevelled tip\", which is over 64 bytes")));
  const std::string given = "[[blocks]]\nname = \"one\"\ntool = \"steel needle\"\n";
  EXPECT_THAT(problems_of_trials(small_trials(by, longer + given)), IsEmpty())
      << "a level that a block gives is no part of the name";
}

// A block that gives the variable of a procedure its value asks none: nothing else says the level.
TEST(TrialMistakesTest, ALevelThatNeedsItself) {
  EXPECT_THAT(problems_of_trials(
                  small_trials(kSmallStaircase, "[practice]\ntrials = 2\nlevel = \"$level\"\n")),
              Contains(HasSubstr("level = \"$level\": level has no value yet")));
  EXPECT_THAT(
      problems_of_trials(small_trials(kSmallStaircase,
                                      "[[blocks]]\nname = \"main\"\n[[blocks]]\nname = \"still\"\n"
                                      "trials = 2\nlevel = \"2 * $level\"\n")),
      Contains(HasSubstr("small.toml: level = \"2 * $level\": level has no value yet")));
}

TEST(TrialMistakesTest, ABlockThatGivesAVariableNoValueIsToldWhatToWrite) {
  const std::string blocks =
      "[[blocks]]\nname = \"main\"\ntouched = \"floor\"\n[[blocks]]\nname = \"bare\"\n";
  EXPECT_THAT(
      problems_of_trials(test::replaced(small_trials(kSmallStaircase, blocks),
                                        "fields = [\"floor\"]", "fields = [\"$touched\"]")),
      Contains(HasSubstr(
          "touched has no value yet; write touched = VALUE in the block, or let a factor")));
}

TEST(TrialMistakesTest, AWordIsNoNumber) {
  EXPECT_THAT(problems_of_trials(
                  test::replaced(kSmall, "{ stiffness = 300.0 }", "{ stiffness = \"'soft'\" }")),
              Contains(HasSubstr("it is the word 'soft', not a number")));
}

TEST(TrialMistakesTest, StagesWithoutAnEnd) {
  EXPECT_THAT(problems_of_trials(test::replaced(kSmall, "until = { time = 0.2 }", "until = {}")),
              Contains(HasSubstr("stages[1].until names no end of the stage")));
  EXPECT_THAT(problems_of_trials(test::replaced(kSmall, "until = { time = 0.2 }",
                                                "until = { contact = \"floor\" }")),
              Contains(HasSubstr("may never come; add timeout")));
}

TEST(TrialMistakesTest, AKeyThatEndsAStageIsNamedAndMayAnswerNothing) {
  const auto ended_by = [](const std::string& keys) {
    return test::replaced(
        kSmall, "until = { time = 0.2 }",
        "timeout = { after = 9.0, then = \"abort\" }\nuntil = { keys = " + keys + " }");
  };
  TrialsDefinition d;
  read_small(ended_by("[\"enter\"]"), d);
  EXPECT_EQ(std::popcount(d.functions_of({kEnterKey})), 1);
  EXPECT_EQ(d.functions_of({kEnterKey}) & d.functions_of({'1'}), 0u);
  EXPECT_THAT(problems_of_trials(ended_by("[\"enter\"]")), IsEmpty());
  EXPECT_THAT(problems_of_trials(ended_by("[\"return\"]")),
              Contains(AllOf(HasSubstr("stages[1].until.keys"), HasSubstr("'return'"),
                             HasSubstr("space, enter, A to Z"))));
}

TEST(TrialMistakesTest, AKeyThatPausesAPlaybackHasNoOtherFunction) {
  EXPECT_THAT(problems_of_trials(kSmall + "[tutoring]\npause_keys = [\"P\"]\n"), IsEmpty());
  EXPECT_THAT(problems_of_trials(kSmall + "[tutoring]\npause_keys = [\"1\"]\n"),
              Contains(AllOf(HasSubstr("tutoring.pause_keys"), HasSubstr("nothing else"))));
  TrialsDefinition d;
  read_small(kSmall + "[tutoring]\npause_keys = [\"P\"]\n", d);
  EXPECT_EQ(d.bits_of({'P'}), kPauseBit);
  EXPECT_EQ(d.bits_of({'P', '1'}), kPauseBit | d.functions_of({'1'}));
}

TEST(TrialMistakesTest, ResponsesWithoutChoices) {
  EXPECT_THAT(problems_of_trials(test::replaced(
                  kSmall, "choices = [{ value = \"first\" }, { value = \"second\" }]\n", "")),
              Contains(HasSubstr("response.question has no one way to be answered; state one of "
                                 "choices, scale, number")));
  EXPECT_THAT(problems_of_trials(test::replaced(kSmall, ", { value = \"second\" }]", "]")),
              Contains(HasSubstr("response.choices is a list of 1; allowed: 2 to 12 choices")));
  EXPECT_THAT(
      problems_of_trials(test::replaced(kSmall, "{ value = \"second\" }",
                                        "{ value = \"second\", keys = [\"1\"] }")),
      Contains(HasSubstr("response.choices[2].keys is that of choices[1]; allowed: a choice "
                         "whose value, keys, buttons")));
}

TEST(TrialMistakesTest, AWordThatNothingEverIsGetsAWarning) {
  const std::string formula = "correct = \"$block == 'main' ? 1 : 2\"";
  TrialsDefinition fits, strays;
  read_small(test::replaced(kSmall, "correct = \"$interval.comparison\"", formula), fits);
  EXPECT_THAT(fits.warnings(), IsEmpty());
  read_small(test::replaced(kSmall, "correct = \"$interval.comparison\"",
                            "correct = \"$block == 'mian' ? 1 : 2\""),
             strays);
  EXPECT_THAT(strays.warnings(), ElementsAre(HasSubstr("compares with 'mian', which nothing in the "
                                                       "definition ever is; did you mean main?")));
}

const char* const kBoxes = R"([regions.near]
type = "sphere"
centre = [0.0, 0.0, 0.03]
radius = 0.01
[regions.far]
type = "sphere"
centre = [0.0, 0.0, -0.03]
radius = 0.01
)";

std::string with_choices(const std::string& choices, const std::string& more = "") {
  return test::replaced(small_trials(kSmallStaircase, kBoxes),
                        "choices = [{ value = \"first\" }, { value = \"second\" }]",
                        "choices = " + choices + "\n" + more);
}

TEST(TrialMistakesTest, AnswersByPlaceAndPedal) {
  const std::string good = "[{ value = \"a\", touch = \"near\" }, { value = \"b\", pedal = 0.5 }]";
  EXPECT_THAT(problems_of_trials(with_choices(good, "touch_for = 0.3\n")), IsEmpty());
  EXPECT_THAT(
      problems_of_trials(with_choices("[{ value = \"a\", touch = \"nea\" }, { value = \"b\" }]")),
      Contains(HasSubstr("response.choices[1].touch is \"nea\"; allowed: a region: far, near")));
  EXPECT_THAT(problems_of_trials(test::replaced(kSmall, "{ value = \"first\" }",
                                                "{ value = \"first\", touch = \"near\" }")),
              Contains(HasSubstr("no region: the definition states none; add [regions.NAME]")));
  EXPECT_THAT(problems_of_trials(with_choices(
                  "[{ value = \"a\", touch = \"near\" }, { value = \"b\", touch = \"near\" }]")),
              Contains(HasSubstr("place and pedal no other choice has")));
  EXPECT_THAT(problems_of_trials(
                  with_choices("[{ value = \"a\", pedal = 0.2 }, { value = \"b\", pedal = 0.8 }]")),
              Contains(HasSubstr("place and pedal no other choice has")));
  EXPECT_THAT(problems_of_trials(
                  with_choices("[{ value = \"a\" }, { value = \"b\" }]", "touch_for = 0.3\n")),
              Contains(HasSubstr("response.touch_for stands alone; add touch")));
}

TEST(TrialMistakesTest, LimitsOfReactionTimes) {
  const std::string two = "[{ value = \"a\" }, { value = \"b\" }]";
  EXPECT_THAT(problems_of_trials(
                  with_choices(two, "too_fast = 0.15\ntoo_slow = 2.0\nout_of_time = \"repeat\"\n")),
              IsEmpty());
  EXPECT_THAT(problems_of_trials(with_choices(two, "out_of_time = \"repeat\"\n")),
              Contains(HasSubstr("response.out_of_time stands alone; add too_fast or too_slow")));
  EXPECT_THAT(problems_of_trials(with_choices(two, "too_fast = 2.0\ntoo_slow = 1.0\n")),
              Contains(HasSubstr("response.too_slow is 1 s; allowed: above too_fast, 2 s")));
  EXPECT_THAT(problems_of_trials(with_choices(two, "too_slow = 3.0\ntimeout = 2.0\n")),
              Contains(HasSubstr("response.too_slow is 3 s; allowed: below timeout, 2 s")));
  // A reaction that counts from a stage may take longer than the time from the question on.
  EXPECT_THAT(problems_of_trials(with_choices(
                  two, "too_slow = 3.0\ntimeout = 2.0\nreaction_time_from = \"press\"\n")),
              IsEmpty());
}

TEST(TrialMistakesTest, RepeatedTrialsThatMayBreakTheOrderGetAWarning) {
  const std::string rule = "[design]\nmost_in_a_row = 2\n";
  TrialsDefinition goes_on, repeats, free;
  read_small(test::replaced(test::replaced(kSmall, "[design]\n", rule),
                            "correct =", "too_slow = 2.0\ncorrect ="),
             goes_on);
  EXPECT_THAT(goes_on.warnings(), IsEmpty());
  const std::string again = "too_slow = 2.0\nout_of_time = \"repeat\"\ncorrect =";
  read_small(test::replaced(test::replaced(kSmall, "[design]\n", rule), "correct =", again),
             repeats);
  EXPECT_THAT(repeats.warnings(),
              ElementsAre(HasSubstr("more trials than design.most_in_a_row says")));
  read_small(test::replaced(kSmall, "correct =", again), free);
  EXPECT_THAT(free.warnings(), IsEmpty());
}

std::vector<std::string> warnings_with(const std::string& procedure) {
  TrialsDefinition definition;
  read_small(small_trials(procedure), definition);
  return definition.warnings();
}

TEST(TrialMistakesTest, AProcedureThatCanLearnNothingGetsAWarning) {
  const std::string stairs = R"([procedure]
kind = "staircase"
variable = "level"
range = [310.0, 600.0]
start = 500.0
steps = [80.0, 40.0, 20.0, 10.0, 5.0, 2.0, 1.0]
stop = { reversals = 4, trials = 60 }
estimate = { of = "mean of reversals", skip = 4 }
)";
  EXPECT_THAT(warnings_with(stairs),
              ElementsAre(HasSubstr("skips 4 reversals, and the track stops at 4"),
                          HasSubstr("3 of 7 sizes of steps are never used")));
  const std::string psi = R"([procedure]
kind = "psi"
variable = "level"
levels = { from = 305.0, to = 600.0, count = 30 }
guess = 0.5
stop = { trials = 40 }
lapse = [0.02]
)";
  EXPECT_THAT(warnings_with(psi), IsEmpty());
  EXPECT_THAT(warnings_with(psi + "threshold = [340.0]\nwidth = [60.0]\n"),
              ElementsAre(HasSubstr("every parameter has one value")));
  EXPECT_THAT(warnings_with(psi + "threshold = [100.0, 200.0]\nwidth = [20.0]\n"),
              ElementsAre(HasSubstr("no threshold that is considered lies within the levels"),
                          HasSubstr("answers to no level tell")));
}

TEST(TrialMistakesTest, ARegionOutOfReachIsRefused) {
  const std::string far =
      "[regions.start]\ntype = \"sphere\"\ncentre = [0.0, 0.3, 0.0]\nradius = 0.01\n";
  EXPECT_THAT(problems_of_trials(test::replaced(small_trials(kSmallStaircase, far),
                                                "until = { time = 0.2 }",
                                                "until = { inside = \"start\" }\n"
                                                "timeout = { after = 5.0, then = \"abort\" }")),
              Contains(HasSubstr("stage press waits until the tool is inside regions.start")));
}

TEST(TrialMistakesTest, AHandThatIsLedBesideTheRegionGetsAWarning) {
  const auto warnings_if_led_to = [](const std::string& to) {
    const std::string more =
        "[fields.guide]\ntype = \"spring\"\nto = " + to +
        "\nstiffness = 150.0\ndamping = 8.0\nlimit = 3.0\n"
        "[regions.start]\ntype = \"sphere\"\ncentre = [0.01, 0.0, 0.0]\nradius = 0.008\n";
    TrialsDefinition d;
    read_small(
        test::replaced(test::replaced(small_trials(kSmallStaircase, more), "until = { time = 0.2 }",
                                      "until = { inside = \"start\" }\n"
                                      "timeout = { after = 5.0, then = \"abort\" }"),
                       "fields = [\"floor\"]", "fields = [\"floor\", \"guide\"]"),
        d);
    return check_every_value(d).warnings;
  };
  EXPECT_THAT(warnings_if_led_to("[0.005, 0.0, 0.0]"), IsEmpty());
  EXPECT_THAT(warnings_if_led_to("[0.0, 0.0, 0.0]"),
              Contains(HasSubstr("inside regions.start, and fields.guide leads it to a place 0.002 "
                                 "m beside it; a hand that is led never arrives")));
}

TEST(TrialMistakesTest, AHandThatIsLedOutOfTheWorkspaceGetsAWarning) {
  const auto warnings_if_led_to = [](const std::string& to) {
    const std::string more = "[fields.guide]\ntype = \"minimum_jerk\"\nto = " + to +
                             "\nduration = 0.5\nstiffness = 150.0\ndamping = 8.0\n";
    TrialsDefinition d;
    read_small(test::replaced(small_trials(kSmallStaircase, more), "fields = [\"floor\"]",
                              "fields = [\"floor\", \"guide\"]"),
               d);
    return check_every_value(d).warnings;
  };
  EXPECT_THAT(warnings_if_led_to("[0.07, 0.0, 0.0]"), IsEmpty());
  EXPECT_THAT(warnings_if_led_to("[0.08, 0.0, 0.0]"),
              Contains(HasSubstr("stage press: fields.guide leads the hand to (0.08, 0, 0) m, "
                                 "beyond the workspace of 0.075 m")));
}

/// A person may go to a region, a virtual participant that rests stays where hands begin.
TEST(TrialMistakesTest, ARegionToWhichNothingLeadsGetsAWarning) {
  const auto warnings_with = [](const std::string& centre, const std::string& observer) {
    const std::string more =
        "[regions.start]\ntype = \"sphere\"\ncentre = " + centre + "\nradius = 0.008\n" + observer;
    TrialsDefinition d;
    read_small(test::replaced(small_trials(kSmallStaircase, more), "until = { time = 0.2 }",
                              "until = { inside = \"start\" }\n"
                              "timeout = { after = 5.0, then = \"abort\" }"),
               d);
    return check_every_value(d).warnings;
  };
  const std::string resting = "[observer.actions]\npress = { do = \"rest\" }\n";
  EXPECT_THAT(warnings_with("[0.0, 0.02, 0.0]", resting),
              Contains(HasSubstr("stage press waits until the tool is inside regions.start, about "
                                 "(0, 0.02, 0) m, and nothing leads it there")));
  EXPECT_THAT(warnings_with("[0.0, 0.0, 0.0]", resting), IsEmpty());
  EXPECT_THAT(warnings_with("[0.0, 0.02, 0.0]",
                            "[observer.actions]\npress = { do = \"reach\", duration = 0.5 }\n"),
              IsEmpty());
  EXPECT_THAT(warnings_with("[0.0, 0.02, 0.0]", ""), IsEmpty()) << "only people take part";
}

TEST(TrialMistakesTest, ABlockThatCannotBeginIsNamed) {
  const std::string blocks =
      "[[blocks]]\nname = \"bare\"\n[[blocks]]\nname = \"main\"\ntouched = \"floor\"\n";
  EXPECT_THAT(
      problems_of_trials(test::replaced(small_trials(kSmallStaircase, blocks),
                                        "fields = [\"floor\"]", "fields = [\"$touched\"]\n")),
      Contains(AllOf(HasSubstr(".toml:"), HasSubstr("cannot begin with the block bare: "
                                                    "touched has no value yet"))));
}

TEST(TrialMistakesTest, AnAnswerThatAProcedureCannotLearnFromIsRefused) {
  const std::string list =
      "[procedure]\nkind = \"constant\"\nvariable = \"level\"\nlevels = [310.0, 400.0]\n"
      "repetitions = 2\n";
  const auto with_counts = [&](const std::string& kind, const std::string& counts) {
    return problems_of_trials(
        small_trials(kind + (counts.empty() ? "" : "counts = \"" + counts + "\"\n")));
  };
  EXPECT_THAT(with_counts(list, "$answer == 1"), IsEmpty());
  EXPECT_THAT(with_counts(list, "$answer"),
              Contains(HasSubstr("track 1 learns 2 from the answer answer = 2; allowed: 0 or 1")));
  const std::string magnitude =
      "[procedure]\nkind = \"magnitude\"\nvariable = \"level\"\nlevels = [310.0, 400.0]\n"
      "repetitions = 2\n";
  EXPECT_THAT(with_counts(magnitude, "$answer"), IsEmpty());
  EXPECT_THAT(with_counts(magnitude, ""), Contains(HasSubstr("allowed: a number above 0")));
}

TEST(TrialMistakesTest, ATrackThatEndsBeforeItsFirstTrialIsRefused) {
  const std::string psi =
      "[procedure]\nkind = \"psi\"\nvariable = \"level\"\nlevels = [310.0, 400.0, 500.0]\n"
      "stop = { trials = 9, entropy = ";
  EXPECT_THAT(problems_of_trials(small_trials(psi + "0.5 }\n")), IsEmpty());
  EXPECT_THAT(problems_of_trials(small_trials(psi + "50.0 }\n")),
              Contains(HasSubstr("stop.entropy is 50 [nat]; allowed: less than the")));
}

TEST(TrialMistakesTest, FeedbackForNoTimeGetsAWarning) {
  const std::string no_time = "[display]\nfeedback_time = 0.0\n";
  TrialsDefinition silent, told, late;
  read_small(test::replaced(small_trials(kSmallStaircase, no_time),
                            "correct =", "feedback = \"never\"\ncorrect ="),
             silent);
  EXPECT_THAT(silent.warnings(), IsEmpty());
  read_small(test::replaced(small_trials(kSmallStaircase, no_time),
                            "correct =", "feedback = \"always\"\ncorrect ="),
             told);
  EXPECT_THAT(told.warnings(), ElementsAre(HasSubstr("display.feedback_time is 0 s")));
  read_small(test::replaced(small_trials(kSmallStaircase, no_time),
                            "correct =", "too_slow = 2.0\ncorrect ="),
             late);
  EXPECT_THAT(late.warnings(), ElementsAre(HasSubstr("so that nothing is shown")));
}

TEST(TrialMistakesTest, ARightAnswerThatIsNoChoice) {
  EXPECT_THAT(problems_of_trials(
                  test::replaced(kSmall, "correct = \"$interval.comparison\"", "correct = \"3\"")),
              Contains(HasSubstr("is 3 (\"3\"), which is no choice")));
}

TEST(TrialMistakesTest, AStepThatRoundingWouldHold) {
  const std::string limits =
      "[procedure]\nkind = \"limits\"\nvariable = \"level\"\nrange = [310.0, 600.0]\nstep = 10.0\n";
  EXPECT_THAT(problems_of_trials(small_trials(limits + "resolution = 5.0\n")), IsEmpty());
  EXPECT_THAT(problems_of_trials(small_trials(limits + "resolution = 25.0\n")),
              Contains(HasSubstr("procedure.resolution is 25; allowed: less than 20, twice the "
                                 "smallest step within the range")));
  EXPECT_THAT(problems_of_trials(small_trials(limits + "resolution = 700.0\n")),
              Contains(HasSubstr("procedure.resolution is 700; allowed: one with a multiple in the "
                                 "range, 310 to 600")));
  // On a scale of ratios the steps are smallest at the low end: there 0.01 decades are 7.2 N/m.
  const std::string log = test::replaced(limits, "step = 10.0", "step = 0.01\nscale = \"log10\"");
  EXPECT_THAT(problems_of_trials(small_trials(log + "resolution = 14.0\n")), IsEmpty());
  EXPECT_THAT(problems_of_trials(small_trials(log + "resolution = 15.0\n")),
              Contains(HasSubstr("procedure.resolution is 15; allowed: less than 14.4")));
}

TEST(TrialMistakesTest, ListedLevelsThatRoundingTakesOutOfTheirRange) {
  EXPECT_THAT(
      problems_of_trials(small_trials("[procedure]\nkind = \"constant\"\nvariable = \"level\"\n"
                                      "levels = [410.0, 420.0]\nrepetitions = 2\n"
                                      "resolution = 50.0\n")),
      Contains(HasSubstr("procedure.resolution is 50; allowed: one with a multiple in the range")));
}

TEST(TrialMistakesTest, TwoProceduresOnOneVariable) {
  std::string two = kSmallStaircase;
  two = test::replaced(two, "[procedure]", "[[procedures]]");
  EXPECT_THAT(
      problems_of_trials(small_trials(two + two)),
      Contains(HasSubstr("procedures set level twice in the block main, by track 1 and by track "
                         "2; name the procedures of each block")));
}

TEST(TrialMistakesTest, TracksOfSeveralProceduresMayEachNameTheirVariable) {
  std::string tracks = test::replaced(kSmallStaircase, "[procedure]", "[[procedures]]");
  tracks = test::replaced(tracks, "variable = \"level\"\n", "");
  const std::string named = "[[procedures.tracks]]\nvariable = \"level\"\n";
  EXPECT_THAT(problems_of_trials(small_trials(tracks + named)), IsEmpty());
  EXPECT_THAT(
      problems_of_trials(small_trials(tracks + named + tracks + named)),
      Contains(HasSubstr("procedures set level twice in the block main, by track 1 and by track "
                         "2; name the procedures of each block")));
}

TEST(TrialMistakesTest, TargetsThatGuessingReaches) {
  EXPECT_THAT(
      problems_of_trials(small_trials(std::string(kSmallStaircase) + "down = 1\n")),
      Contains(HasSubstr("is in balance at 50 % right answers (\"track 1\"), which guessing "
                         "gives")));
}

TEST(TrialMistakesTest, LevelsOutsideOfTheDevice) {
  const std::string pull =
      "[fields.pull]\ntype = \"constant\"\nforce = [0.0, \"-$level / 40\", 0.0]\n";
  EXPECT_THAT(problems_of_trials(small_trials(kSmallStaircase, pull)),
              ElementsAre(HasSubstr("fields.pull asks for 15 N; allowed: at most 8 [N], "
                                    "envelope.max_force"),
                          HasSubstr("with block main, level = 600")));
}

/// A force that is held for a tick and comes a tick late feeds K (T/2 + T) N·s/m to the hand.
TEST(TrialMistakesTest, AFieldThatTheHandDoesNotCarryGetsAWarningAndOneThatNoHandCarriesIsRefused) {
  const auto words = [](const char* stiffness) {
    TrialsDefinition definition;
    read_small(test::replaced(kSmall, "\"$stiffness\"", stiffness), definition);
    return check_every_value(definition);
  };
  EXPECT_THAT(words("400.0").warnings, IsEmpty());
  EXPECT_THAT(words("400.0").lines,
              Not(Contains(HasSubstr("for lighter ones haptrial reduces them"))));
  EXPECT_THAT(words("2000.0").warnings, IsEmpty());
  EXPECT_THAT(words("2000.0").lines,
              Contains(AllOf(HasSubstr("add up to 2000 N/m"),
                             HasSubstr("for lighter ones haptrial reduces them"))));
  EXPECT_THAT(words("20000.0").warnings,
              ElementsAre(AllOf(HasSubstr("add up to 20000 N/m"),
                                HasSubstr("the hand of [hand] has 0.8 kg"))));
  EXPECT_THAT(problems_of_trials(test::replaced(kSmall, "\"$stiffness\"", "90000.0")),
              Contains(AllOf(HasSubstr("no hand of up to 2 kg carries that at 1000 Hz"),
                             HasSubstr("allowed: less of it"))));
}

/// A mass m on a spring k swings at sqrt(k / m) / 2 pi, which is 9 Hz for 5000 N/m and 1.5 kg.
TEST(TrialMistakesTest, AWallThatSwingsAsSlowlyAsATremorIsRefused) {
  const auto problems = [](const char* rate, const char* delay) {
    return problems_of_trials(test::replaced(test::replaced(kSmall, "\"$stiffness\"", "5000.0"),
                                             "[experiment]\n",
                                             fmt::format("[experiment]\nrate = {}\n", rate)) +
                              fmt::format("[device]\nforce_delay = {}\n", delay));
  };
  EXPECT_THAT(problems("1000.0", "1"), IsEmpty());
  EXPECT_THAT(problems("500.0", "3"),
              Contains(AllOf(HasSubstr("add up to 5000 N/m"), HasSubstr("3 ticks late"),
                             HasSubstr("cannot be told from a tremor"))));
}

TEST(TrialMistakesTest, AWallIsJudgedByTheDelayOfTheDeviceThatFeelsIt) {
  const auto problems = [](const std::string& device) {
    return problems_of_trials(
        test::replaced(test::replaced(test::replaced(kSmall, "\"$stiffness\"", "5000.0"),
                                      "[experiment]\n", "[experiment]\nrate = 500.0\n"),
                       "[fields.floor]\n", "[fields.floor]\ndevice = \"" + device + "\"\n") +
        "[devices.near]\nstart = [0.0, 0.0, 0.0]\n"
        "[devices.far]\nstart = [0.0, 0.0, 0.0]\nforce_delay = 3\n");
  };
  EXPECT_THAT(problems("near"), IsEmpty());
  EXPECT_THAT(problems("far"), Contains(AllOf(HasSubstr("fields on far add up to 5000 N/m"),
                                              HasSubstr("3 ticks late"))));
}

TEST(TrialMistakesTest, AForceThatActsWhileThePassRampsInGetsAWarning) {
  const auto warnings = [](const std::string& field, const std::string& first) {
    TrialsDefinition d;
    read_small(test::replaced(small_trials(kSmallStaircase, "[fields.pull]\n" + field),
                              "[[stages]]\n", first + "[[stages]]\n"),
               d);
    return check_every_value(d).warnings;
  };
  const std::string pulse = "type = \"pulse\"\nforce = [0.0, -4.0, 0.0]\nduration = 0.05\n";
  const std::string constant = "type = \"constant\"\nforce = [0.0, -1.0, 0.0]\n";
  const auto stage = [](const std::string& name, const std::string& time, bool pulls) {
    return "[[stages]]\nname = \"" + name + "\"\n" + (pulls ? "fields = [\"pull\"]\n" : "") +
           "until = { time = " + time + " }\n";
  };
  EXPECT_THAT(warnings(pulse, stage("early", "0.6", true)),
              ElementsAre(HasSubstr("fields.pull has a course in time, which begins with the first "
                                    "stage, early, while the device's force ramps in for 0.1 s")));
  EXPECT_THAT(warnings(constant, stage("early", "0.05", true)),
              ElementsAre(HasSubstr("fields.pull acts in the stage early, which is the first and "
                                    "ends after 0.05 s, while the device's force ramps in")));
  EXPECT_THAT(warnings(constant, stage("early", "0.6", true)), IsEmpty());
  EXPECT_THAT(warnings(pulse, stage("rest", "0.3", false) + stage("early", "0.6", true)),
              IsEmpty());
}

TEST(TrialMistakesTest, ARegionOutsideOfThePictureGetsAWarning) {
  const auto warnings = [](const std::string& more) {
    TrialsDefinition definition;
    read_small(
        test::replaced(kSmall, "fields = [\"floor\"]", "fields = [\"floor\"]\nshow = [\"start\"]") +
            "[regions.start]\ntype = \"sphere\"\ncentre = [0.0, 0.045, 0.0]\nradius = "
            "0.008\n" +
            more,
        definition);
    return check_every_value(definition).warnings;
  };
  EXPECT_THAT(warnings(""), ElementsAre(AllOf(HasSubstr("region start lies partly outside"),
                                              HasSubstr("display.extent = 0.19"))));
  EXPECT_THAT(warnings("[display]\nextent = 0.19\n"), IsEmpty());
}

TEST(TrialMistakesTest, NothingToLearnFrom) {
  EXPECT_THAT(
      problems_of_trials(test::replaced(kSmall, "correct = \"$interval.comparison\"\n", "")),
      Contains(HasSubstr("no response says which is right")));
}

TEST(TrialMistakesTest, AProcedureWithoutAnEnd) {
  EXPECT_THAT(
      problems_of_trials(test::replaced(kSmall, "reversals = 6, trials = 40", "reversals = 6")),
      Contains(HasSubstr("procedure.stop names no number of trials, so a session might "
                         "never end")));
}

TEST(TrialMistakesTest, UnknownKeysAndTables) {
  EXPECT_THAT(
      problems_of_trials(
          test::replaced(kSmall, "start = 500.0", "start = 500.0\nresolutoin = 3.0")),
      Contains(HasSubstr("procedure.resolutoin is not a known key; did you mean resolution?")));
  EXPECT_THAT(problems_of_trials(small_trials(kSmallStaircase, "[variabels]\n")),
              Contains(HasSubstr("[variabels] is not a known table; did you mean variables?")));
}

TEST(TrialMistakesTest, AFieldThatAFactorNames) {
  const std::string factor = "[factors]\nfield = [\"floor\", \"flor\"]\n";
  EXPECT_THAT(problems_of_trials(test::replaced(small_trials(kSmallStaircase, factor),
                                                "fields = [\"floor\"]", "fields = [\"$field\"]")),
              Contains(AllOf(HasSubstr("stages[1].fields is \"flor\""), HasSubstr("floor"))));
}

std::string on_days(const std::string& days) {
  const std::string blocks = "[[blocks]]\nname = \"a\"\n[[blocks]]\nname = \"b\"\n";
  return test::replaced(kSmall, "participants = 4", "participants = 4\nsessions = 2") + blocks +
         days;
}

TEST(TrialMistakesTest, SessionsOnSeveralDays) {
  const std::string first = "[design.session.1]\nblocks = [\"a\"]\n";
  const std::string second = "[design.session.2]\nblocks = [\"b\"]\n";
  EXPECT_THAT(problems_of_trials(on_days("")), IsEmpty());
  EXPECT_THAT(problems_of_trials(on_days(first + second)), IsEmpty());
  EXPECT_THAT(problems_of_trials(on_days(first)),
              Contains(HasSubstr("design.session says nothing of session 2; add "
                                 "[design.session.2] with its blocks")));
  EXPECT_THAT(problems_of_trials(on_days(first + test::replaced(second, "\"b\"", "\"a\""))),
              ElementsAre(HasSubstr("leaves out the block \"b\"")));
  EXPECT_THAT(problems_of_trials(on_days(first + test::replaced(second, "\"b\"", "\"b\", \"c\""))),
              ElementsAre(AllOf(HasSubstr("design.session.2.blocks is an array with \"c\""),
                                HasSubstr("allowed: blocks of the definition: a, b"))));
  EXPECT_THAT(
      problems_of_trials(on_days(first + second + "[design.session.3]\nblocks = [\"a\"]\n")),
      ElementsAre(HasSubstr("design.session.3")));
}

}  // namespace
}  // namespace haptrial::protocols::mistakes_test
