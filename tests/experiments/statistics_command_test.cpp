// haptrial statistics: the tests of a table, and what it says of one that cannot be tested.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "tests/experiments/command.h"
#include "tests/experiments/shipped.h"
#include "tests/support/temporary_folder.h"

namespace haptrial {
namespace {

using test::CommandResult;
using test::run_command;
using testing::HasSubstr;

class StatisticsCommandTest : public testing::Test {
 protected:
  std::string file(const std::string& name, const std::string& text) {
    test::write_text(folder_ / name, text);
    return fmt::format("'{}'", (folder_ / name).string());
  }

  /// Experts and novices, two conditions each, one value for each.
  std::string groups() {
    std::string text = "who,group,speed,error\n";
    for (int i = 0; i < 6; ++i) {
      const char* group = i < 3 ? "expert" : "novice";
      text += fmt::format("P{0},{1},slow,{2}\nP{0},{1},fast,{3}\n", i, group, 1 + i * i % 5, 2 + i);
    }
    return file("groups.csv", text);
  }

  test::TemporaryFolder folder_;
};

TEST_F(StatisticsCommandTest, TestsTheShippedScoresAsTheReportDoes) {
  const std::string results = fmt::format("{}/results/force_training/", HAPTRIAL_SOURCE_DIR);
  const std::string json = (folder_ / "tests.json").string();
  const CommandResult run = run_command(
      fmt::format("haptrial statistics '{}scores.csv' --planned 'visual < haptic' --planned "
                  "'visuohaptic < visual' --reference haptic --json '{}'",
                  results, json));
  ASSERT_EQ(run.status, 0) << run.errors;
  EXPECT_THAT(run.output, HasSubstr("Varied within participants: condition (haptic, visual, "
                                    "visuohaptic)"));
  const auto ours = nlohmann::json::parse(test::read_text(json));
  const auto theirs = nlohmann::json::parse(test::read_text(results + "statistics.json"));
  EXPECT_EQ(ours, theirs["participants_as_unit"]);
}

TEST_F(StatisticsCommandTest, FindsTheDesignOfSeveralFactors) {
  const CommandResult run = run_command("haptrial statistics " + groups() +
                                        " --subject who --factor group --factor speed --value "
                                        "error --planned 'slow < fast' --planned 'expert != "
                                        "novice'");
  ASSERT_EQ(run.status, 0) << run.errors;
  EXPECT_THAT(run.output, HasSubstr("Varied within participants: speed (fast, slow); between "
                                    "participants: group (expert, novice)"));
  EXPECT_THAT(run.output, HasSubstr("(mixed analysis of variance"));
  EXPECT_THAT(run.output, HasSubstr("paired t(2.6) = -1.94"));
  EXPECT_THAT(run.output, HasSubstr("Mann–Whitney"));
}

// Eight people in two groups, both numbered from 1; R: t.test(score ~ group).
TEST_F(StatisticsCommandTest, PeopleWhoseNumbersAreUsedAgainAreDifferentPeople) {
  const std::string table =
      "haptrial statistics " +
      file("again.csv",
           "subject,group,score\n1,novice,4.1\n2,novice,5.0\n3,novice,4.6\n4,novice,5.3\n"
           "1,expert,6.0\n2,expert,5.1\n3,expert,6.3\n4,expert,5.2\n") +
      " --factor group";
  EXPECT_THAT(run_command(table).output, HasSubstr("novice); 4 participants\n"));
  const CommandResult stated = run_command(table + " --between group");
  EXPECT_EQ(stated.status, 2);
  EXPECT_THAT(stated.errors,
              HasSubstr("1, 2, 3, 4 have several levels of group (expert, novice); correct the "
                        "rows, or, if it is another person under each level, add --subject group"));
  const CommandResult people = run_command(table + " --subject subject --subject group");
  ASSERT_EQ(people.status, 0) << people.errors;
  EXPECT_THAT(people.output, HasSubstr("between participants: group (expert, novice); 8 "));
  EXPECT_THAT(people.output, HasSubstr("Welch's t(5.9) = 2.29, p = 0.063"));
  EXPECT_THAT(run_command(table + " --between speed").errors,
              HasSubstr("--between names 'speed', which is no factor; allowed: 'group'"));
}

TEST_F(StatisticsCommandTest, OneWrongRowIsNamed) {
  const CommandResult run = run_command(
      "haptrial statistics " +
      file("wrong.csv",
           "subject,group,time,score\nc1,con,pre,10.1\nc1,con,post,10.9\nc2,con,pre,9.4\n"
           "c2,con,post,10.2\nc3,con,pre,10.8\nc3,pat,post,11.1\np1,pat,pre,12.0\n"
           "p1,pat,post,13.1\np2,pat,pre,11.6\np2,pat,post,12.2\n") +
      " --factor group --factor time");
  EXPECT_EQ(run.status, 2);
  EXPECT_THAT(run.errors, HasSubstr("c3 has several levels of group (con, pat), and most "
                                    "participants have one; correct the rows"));
}

TEST_F(StatisticsCommandTest, ANumberIsNotTakenForGroups) {
  std::string text = "subject,age,score\n";
  for (int i = 0; i < 20; ++i) {
    text += fmt::format("P{},{},{}\n", i, 20 + i % 16, i * i % 7);
  }
  const CommandResult run =
      run_command("haptrial statistics " + file("ages.csv", text) + " --factor age");
  EXPECT_EQ(run.status, 2);
  EXPECT_THAT(run.errors, HasSubstr("age has 16 levels for 20 participants, too few in each"));
}

TEST_F(StatisticsCommandTest, RowsWithMissingFieldsAreLeftOutAndCountedIfAsked) {
  const std::string rows = "subject,condition,score\nA,x,1\nA,y,2\nB,x,2\nB,y,4\nC,x,1\nC,y,2.5\n";
  const std::string missing =
      "haptrial statistics " + file("missing.csv", rows + "D,x,NA\nD,y,3\nE,x,\n,,\n,,\n");
  const CommandResult refused = run_command(missing);
  EXPECT_EQ(refused.status, 2);
  EXPECT_THAT(refused.errors, HasSubstr("missing.csv:8: score is 'NA'; allowed: a name or a "
                                        "number, or --leave-out-missing"));
  const CommandResult run = run_command(missing + " --leave-out-missing");
  ASSERT_EQ(run.status, 0) << run.errors;
  EXPECT_THAT(run.output, HasSubstr("Left out: 4 of 11 rows, which have a missing field\n"));
  EXPECT_THAT(run.output, HasSubstr("Left out for lack of a value in some condition: D\n"));
  EXPECT_THAT(run.output, HasSubstr("paired t(2) = -5.20"));
  EXPECT_THAT(
      run_command("haptrial statistics " + file("nothing.csv", "subject,condition,score\nA,x,\n") +
                  " --leave-out-missing")
          .errors,
      HasSubstr("every row has a missing field"));
}

TEST_F(StatisticsCommandTest, WarnsOfLevelsThatDifferOnlyInCapitals) {
  const std::string table = file("t.csv",
                                 "subject,condition,score\nA,visual,1\nA,haptic,2\nB,Visual,3\n"
                                 "B,haptic,4\nC,visual,2\nC,haptic,5\n");
  const CommandResult run =
      run_command("haptrial statistics " + table + " --seed 18446744073709551615");
  EXPECT_THAT(
      run.errors,
      HasSubstr("WARNING: the names of levels of condition differ only in "
                "blanks, hyphens, capitals or zeros that change no number and are taken for "
                "different levels of condition: \"Visual\", \"visual\"."));
  const std::string people = file("people.csv",
                                  "subject,condition,score\nA,x,1\nA,y,2\nb1,x,3\nB01,y,4\n"
                                  "C,x,2\nC,y,5\nD,x,1\nD,y,3\n");
  EXPECT_THAT(run_command("haptrial statistics " + people).errors,
              HasSubstr("taken for different participants: \"B01\", \"b1\"."));
  EXPECT_THAT(run_command("haptrial statistics " + table + " --seed -1").errors,
              HasSubstr("--seed is '-1'; allowed: a whole number from 0 to 18446744073709551615"));
}

TEST_F(StatisticsCommandTest, NothingThatExistsIsWrittenOver) {
  const std::string table = groups();
  const CommandResult run =
      run_command(fmt::format("haptrial statistics {0} --subject who --factor speed --value error "
                              "--json {0}",
                              table));
  EXPECT_EQ(run.status, 2);
  EXPECT_THAT(run.errors, HasSubstr("exists already; choose another --json"));
  EXPECT_THAT(test::read_text(folder_ / "groups.csv"), HasSubstr("who,group,speed,error"));
}

TEST_F(StatisticsCommandTest, OneParticipantAndOneConditionAreSaidPlainly) {
  const std::string one = file("one.csv", "subject,condition,score\nP,x,1\nP,x,3\n");
  const CommandResult run = run_command("haptrial statistics " + one);
  ASSERT_EQ(run.status, 0) << run.errors;
  EXPECT_THAT(run.output, HasSubstr("Varied nothing: there is one condition, x"));
  EXPECT_THAT(run.output, HasSubstr("x: mean 2.000 (1 participant, 2 values)"));
}

TEST_F(StatisticsCommandTest, ValuesBeyondWhatCanBeComputedGetASentence) {
  const std::string huge =
      file("huge.csv", "subject,condition,value\nA,x,1\nA,y,1e308\nB,x,2\nB,y,3\nC,x,1\nC,y,5\n");
  const CommandResult run = run_command("haptrial statistics " + huge + " --value value");
  EXPECT_EQ(run.status, 0) << run.errors;
  EXPECT_THAT(run.output, HasSubstr("y: mean not defined, because the values are too large"));
}

TEST_F(StatisticsCommandTest, EqualSeedsGiveEqualLinesWhateverTheThreads) {
  const std::string command =
      "haptrial statistics " + groups() + " --subject who --factor speed --value error --jobs ";
  EXPECT_EQ(run_command(command + "1").output, run_command(command + "3").output);
}

TEST_F(StatisticsCommandTest, WhatCannotBeTestedGetsASentence) {
  struct Case {
    const char* options;
    const char* sentence;
  };
  for (const auto& [options, sentence] :
       {Case{"--value error --factor speed", "subject"},
        Case{"--subject who --value error --factor speed --planned 'slow < quick'",
             "names 'quick', which the data do not have; allowed: 'fast', 'slow'"},
        Case{"--subject who --value error --factor speed --planned 'slow'", "--planned is"},
        Case{"--subject who --value group --factor speed", "group is 'expert'"},
        Case{"--subject who --value error --factor speed --resamples -1", "--resamples"},
        Case{"--subject who --value error",
             "there is no column 'condition'; allowed: who, group, speed, error; a row has one "
             "value, with its participant and condition beside it"},
        Case{"--subject who --value error --factor speed --reference quick",
             "the reference condition names 'quick'"}}) {
    const CommandResult run =
        run_command(fmt::format("haptrial statistics {} {}", groups(), options));
    EXPECT_EQ(run.status, 2) << options;
    EXPECT_THAT(run.errors, HasSubstr(sentence));
  }
}

}  // namespace

// haptrial power: what it prints, and how it refuses.

namespace {

std::string printed(const std::string& arguments) {
  const CommandResult result = run_command("haptrial power " + arguments);
  EXPECT_EQ(result.status, 0) << arguments << "\n" << result.errors;
  return result.output;
}

void expect_refused(const std::string& arguments, const std::string& sentence) {
  const CommandResult result = run_command("haptrial power " + arguments);
  EXPECT_EQ(result.status, 2) << arguments;
  EXPECT_THAT(result.errors, HasSubstr(sentence)) << arguments;
  EXPECT_EQ(std::count(result.errors.begin(), result.errors.end(), '\n'), 1) << result.errors;
  EXPECT_EQ(result.output, "") << arguments;
}

TEST(PowerCommand, TheDifferenceKeepsItsSign) {
  EXPECT_THAT(printed("t --delta -1 --n 20"),
              HasSubstr("difference    -1, -1 standard deviation\n"));
  EXPECT_THAT(printed("t --delta 3 --sd 2 --n 20"),
              HasSubstr("difference    3, 1.5 standard deviations\n"));
}

// The sizes are those of Cohen 1988, tables 2.4.1 and 8.4.4, and of R's power.t.test.
TEST(PowerCommand, SaysHowManyParticipants) {
  EXPECT_EQ(printed("t --delta 0.5 --sd 1 --power 0.8"),
            "two-sample t test, two-tailed, significance level 0.05\n"
            "difference    0.5, 0.5 standard deviations\n"
            "participants  64 in each of 2 groups, 128 in all\n"
            "power         0.8015\n");
  EXPECT_THAT(printed("t --design paired --one-tailed --delta -10 --sd 20 --power 0.8"),
              HasSubstr("participants  27\n"));
  EXPECT_THAT(printed("anova --groups 3 --f 0.25 --power 0.8"),
              HasSubstr("participants  53 in each of 3 groups, 159 in all\n"));
}

TEST(PowerCommand, HelpShowsAnExampleThatWorks) {
  const std::string example = "haptrial power t --design paired --delta 20 --sd 35 --power 0.8";
  EXPECT_THAT(run_command("haptrial power --help").output, HasSubstr("Example:\n  " + example));
  EXPECT_EQ(run_command(example).status, 0);
}

TEST(PowerCommand, ComputesWhicheverIsMissing) {
  EXPECT_THAT(printed("t --delta 5 --sd 10 --n 64"), HasSubstr("power         0.8015\n"));
  EXPECT_THAT(printed("t --sd 10 --n 64 --power 0.8015"), HasSubstr("difference    5.00"));
  EXPECT_THAT(printed("anova --groups 3 --f 0.25 --n 53"), HasSubstr("power         0.80"));
  EXPECT_THAT(printed("anova --groups 3 --n 53 --power 0.8049"),
              HasSubstr("effect        f = 0.25"));
  EXPECT_THAT(printed("t --design one-sample --delta 1 --n 10 --alpha 0.01"),
              HasSubstr("one-sample t test, two-tailed, significance level 0.01"));
}

TEST(PowerCommand, PlansRepeatedMeasuresAndMixedDesigns) {
  EXPECT_THAT(printed("repeated --measurements 3 --f 0.25 --power 0.8"),
              testing::AllOf(HasSubstr("within participants, 1 group, 3 measurements"),
                             HasSubstr("participants  28\n")));
  EXPECT_THAT(printed("repeated --groups 2 --measurements 4 --effect interaction --f 0.25 --n 18"),
              HasSubstr("participants  18 in each of 2 groups, 36 in all\n"));
}

TEST(PowerCommand, RefusesWithASentence) {
  expect_refused("", "TEST");
  expect_refused("u", "TEST is 'u'; allowed: t, anova, repeated");
  expect_refused("t --delta 1", "give two of --delta, --n and --power; the third is computed");
  expect_refused("t", "give two of --delta, --n and --power");
  expect_refused("t --delta 1 --n 4 --power 0.9", "give two of --delta, --n and --power");
  expect_refused("t --f 0.2 --n 9", "--f is given with t; use it with anova or repeated only");
  expect_refused("anova --groups 3 --delta 0.2 --n 9", "--delta is given with anova");
  expect_refused("anova --f 0.2 --n 9", "--groups is missing");
  expect_refused("anova --groups 1 --f 0.2 --n 9", "--groups is 1; allowed: a whole number from 2");
  expect_refused("anova --groups 3 --f -1 --n 9", "--f is -1; allowed: a number above 0");
  expect_refused("t --delta 0 --power 0.8", "--delta is 0; allowed: a number other than 0");
  expect_refused("t --delta nan --power 0.8", "--delta is nan");
  expect_refused("t --delta 1 --sd 0 --n 9", "--sd is 0; allowed");
  expect_refused("t --delta 1 --n 1", "--n is 1; allowed: a whole number of at least 2");
  expect_refused("t --delta 1 --n many", "many");
  expect_refused("t --delta 1 --power 1.5", "--power is 1.5; allowed: a number between 0.05 and 1");
  expect_refused("t --delta 1 --power 0.8 --alpha 2", "--alpha is 2; allowed");
  expect_refused("t --delta 1 --power 0.8 --design triple", "--design is 'triple'; allowed");
  expect_refused("t --delta 1 --power 0.8 --design piared",
                 "--design is 'piared'; did you mean paired? allowed: ");
  expect_refused("t --delta -1 --power 0.8 --one-tailed --sd 1e9",
                 "more than ten million participants would be needed");
  expect_refused("t --delta 1e9 --n 9", "100 standard deviations");
  expect_refused("repeated --f 0.2 --n 9", "--measurements is missing");
  expect_refused("repeated --measurements 3 --f 0.2 --n 9 --correlation 1", "--correlation is 1");
  expect_refused("repeated --measurements 3 --f 0.2 --n 9 --epsilon 0.4",
                 "--epsilon is 0.4; allowed: a number from 1 / (measurements - 1) = 0.5 to 1");
  expect_refused("repeated --measurements 3 --f 0.2 --n 9 --effect within --groups 0",
                 "--groups is 0; allowed: a whole number from 1");
  expect_refused("repeated --measurements 3 --f 0.2 --n 9 --effect betwen",
                 "--effect is 'betwen'; did you mean between?");
  expect_refused("t --delta 1 --n 9 --epsilon 1", "use it with repeated only");
}

}  // namespace
}  // namespace haptrial
