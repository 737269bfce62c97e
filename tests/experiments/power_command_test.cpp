// haptrial power: what it prints, and how it refuses.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "tests/experiments/command.h"

namespace haptrial {
namespace {

using test::CommandResult;
using test::run_command;
using testing::HasSubstr;

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
