// Demands of a stage's fields on hands: what is refused, warned of and named before anybody comes.

#include "protocols/psychophysics/definition/handle_text.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <utility>
#include <vector>

#include "protocols/psychophysics/definition/every_value.h"
#include "tests/protocols/psychophysics/definition/small_definition.h"
#include "tests/support/replaced.h"

namespace haptrial::protocols::handle_text_test {
namespace {

using testing::AllOf;
using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

/// A study of one stage, "feel". @param tables  its fields and what more there is
std::string felt(const std::string& fields, const std::string& tables) {
  return fmt::format(R"([experiment]
protocol = "trials"
name = "felt"
[design]
participants = 2
[[stages]]
name = "feel"
fields = [{}]
until = {{ time = 1.0 }}
[response]
question = "Did you feel it?"
choices = [{{ value = "yes" }}, {{ value = "no" }}]
[[blocks]]
name = "one"
trials = 1
{})",
                     fields, tables);
}

HandleText words_of(const std::string& text) {
  TrialsDefinition definition;
  read_small(text, definition);
  return check_every_value(definition);
}

const std::string kWall =
    "[fields.wall]\ntype = \"wall\"\npoint = [0.0, 0.0, 0.0]\nnormal = [0.0, 1.0, 0.0]\n"
    "stiffness = 1000.0\ndamping = 2.0\nlimit = 8.0\n";

// On a surface that is pressed with 8 N, a coefficient of 0.95 holds as hard as 7.6 N do.
TEST(HandleTextTest, FrictionOnASurfaceHoldsWithItsCoefficientTimesThePress) {
  const auto rubbing = [](const std::string& level, double stiffness) {
    return problems_of_trials(
        felt(R"("wall", "rub")",
             kWall + fmt::format("[fields.rub]\ntype = \"friction\"\n{}stiffness = {}\n", level,
                                 stiffness)));
  };
  const std::string on_wall = "on = \"wall\"\nstatic = 0.95\ndynamic = 0.9\n";
  const std::string in_space = "static = 7.6\ndynamic = 7.2\n";
  EXPECT_THAT(rubbing(on_wall, 1e5), Contains(AllOf(HasSubstr("add up to 101000 N/m"),
                                                    HasSubstr("no hand of up to 2 kg"))));
  EXPECT_EQ(rubbing(on_wall, 1e5), rubbing(in_space, 1e5));
  EXPECT_THAT(rubbing(on_wall, 2000.0), IsEmpty());
  // To and fro, 0.09 of 8 N are less than what counts as an oscillation, and 0.99 N are not.
  EXPECT_THAT(rubbing("on = \"wall\"\nstatic = 0.09\ndynamic = 0.08\n", 1e5), IsEmpty());
  EXPECT_THAT(rubbing("static = 0.99\ndynamic = 0.9\n", 1e5), Not(IsEmpty()));
}

TEST(HandleTextTest, AValueThatADryRunNeverHasIsWarnedOf) {
  const auto waiting = [](const std::string& above, const std::string& then,
                          const std::string& simulated) {
    const std::string until = fmt::format(
        "until = {{ channel = \"grip\", above = {} }}\ntimeout = {{ after = 5.0, then = \"{}\" }}",
        above, then);
    return words_of(test::replaced(felt(R"("wall")", kWall +
                                                         "[channels.grip]\nkind = \"line\"\npath = "
                                                         "\"/dev/ttyACM0\"\n"
                                                         "quantities = { force = \"N\" }\n" +
                                                         simulated),
                                   "until = { time = 1.0 }", until))
        .warnings;
  };
  const std::string sine = "simulated = { mean = 1.0, amplitude = 1.5 }\n";
  EXPECT_THAT(waiting("2.0", "abort", ""),
              Contains(AllOf(HasSubstr("stage feel waits for a value of channel grip"),
                             HasSubstr("from 0 to 0"))));
  EXPECT_THAT(waiting("2.5", "abort", sine),
              Contains(AllOf(HasSubstr("from -0.5 to 2.5"), HasSubstr("(first with block "))));
  // A sine of 0.5 Hz is above its mean for a second, and above 1.75 for a third of its period.
  EXPECT_THAT(waiting("1.0, for = 1.1", "abort", sine), Contains(HasSubstr("never has for 1.1 s")));
  EXPECT_THAT(waiting("1.0, for = 0.9", "abort", sine), Not(Contains(HasSubstr("grip"))));
  EXPECT_THAT(waiting("1.75, for = 0.68", "abort", sine), Contains(HasSubstr("for 0.68 s")));
  EXPECT_THAT(waiting("1.75, for = 0.65", "abort", sine), Not(Contains(HasSubstr("grip"))));
  EXPECT_THAT(waiting("2.0", "abort", sine), Not(Contains(HasSubstr("grip"))));
  EXPECT_THAT(waiting("2.0", "go on", ""), Not(Contains(HasSubstr("grip"))));
}

// A hand of 2 kg has 15 N·s/m for each 0.8 kg, 37.5 N·s/m.
TEST(HandleTextTest, AMatrixThatPushesMovementsOnIsWarnedOfAndRefusedIfNoHandDampsIt) {
  const auto medium = [](const char* matrix) {
    return felt(R"("medium")", fmt::format("[fields.medium]\ntype = \"matrix_viscous\"\n"
                                           "matrix = [{}]\nvelocity_filter = 50.0\n",
                                           matrix));
  };
  const char* const pushes = "[20.0, 0.0, 0.0], [0.0, 20.0, 0.0], [0.0, 0.0, 20.0]";
  EXPECT_THAT(words_of(medium(pushes)).warnings,
              ElementsAre(AllOf(HasSubstr("stage feel: its fields push movements on with up to 20 "
                                          "N·s/m: hands that damp less swing up"),
                                HasSubstr("that of [hand] damps 15 N·s/m"))));
  EXPECT_THAT(problems_of_trials(medium("[60.0, 0.0, 0.0], [0.0, 60.0, 0.0], [0.0, 0.0, 60.0]")),
              Contains(AllOf(HasSubstr("push movements on with up to 60 N·s/m"),
                             HasSubstr("hands of up to 2 kg damp no more than 37.5 N·s/m"),
                             HasSubstr("the matrix of a damper is negative"))));
  // The saddle of Shadmehr and Mussa-Ivaldi (1994): 0.5 + sqrt(10.6² + 11.2²) N·s/m along one axis.
  EXPECT_THAT(words_of(medium("[-10.1, 0.0, -11.2], [0.0, 0.0, 0.0], [-11.2, 0.0, 11.1]")).warnings,
              ElementsAre(HasSubstr("up to 15.9 N·s/m")));
  for (const char* calm : {"[-60.0, 0.0, 0.0], [0.0, -60.0, 0.0], [0.0, 0.0, -60.0]",
                           "[0.0, 0.0, 13.0], [0.0, 0.0, 0.0], [-13.0, 0.0, 0.0]"}) {
    EXPECT_THAT(words_of(medium(calm)).warnings, IsEmpty()) << calm;
  }
}

// A damper of 30 N·s/m in every direction takes more than the matrix gives.
TEST(HandleTextTest, ADamperBesideAMatrixThatPushesTakesItsEnergy) {
  const std::string both =
      "[fields.medium]\ntype = \"matrix_viscous\"\n"
      "matrix = [[20.0, 0.0, 0.0], [0.0, 20.0, 0.0], [0.0, 0.0, 20.0]]\nvelocity_filter = 50.0\n"
      "[fields.oil]\ntype = \"viscous\"\ndamping = 30.0\n";
  EXPECT_THAT(words_of(felt(R"("medium", "oil")", both)).warnings, IsEmpty());
}

// A wall that is calm with its own damper needs a heavier hand without it; a matrix that pushes
// movements on is no damper beside it.
TEST(HandleTextTest, AMatrixThatPushesIsNoDamperOfAWall) {
  const auto beside = [](const std::string& fields) {
    return words_of(felt(fields, kWall + "[fields.medium]\ntype = \"matrix_viscous\"\n"
                                         "matrix = [[15.0, 0.0, 0.0], [0.0, 15.0, 0.0], [0.0, 0.0, "
                                         "15.0]]\nvelocity_filter = 50.0\n"))
        .lines;
  };
  EXPECT_EQ(beside(R"("wall", "medium")"), beside(R"("wall")"));
}

std::string ridged(double amplitude, double period) {
  return felt(R"("wall", "ridges")",
              kWall + fmt::format("[fields.ridges]\ntype = \"grating\"\non = \"wall\"\n"
                                  "direction = [1.0, 0.0, 0.0]\namplitude = {}\nperiod = {}\n",
                                  amplitude, period));
}

// A sine of amplitude A and period p has s = 2 pi A / p and c = s 2 pi / p. The definitions were
// found to swing, or to be calm, by dry runs of a hand of 0.8 kg that rests on them with 3 N.
TEST(HandleTextTest, RidgesAreCountedAsStiffAsTheirGroovesAre) {
  // 1000 (1 + s²) + 8 / (1 + s) c
  EXPECT_THAT(problems_of_trials(ridged(5e-4, 1e-3)),  // swings by 5.0 N
              Contains(AllOf(HasSubstr("its fields and the ridges on them add up to 48998.3 N/m"),
                             HasSubstr("or ridges of at most "))));
  EXPECT_THAT(problems_of_trials(ridged(2e-4, 5e-4)), Not(IsEmpty()));  // swings by 3.4 N
  EXPECT_THAT(problems_of_trials(ridged(1e-4, 5e-4)), Not(IsEmpty()));  // swings by 3.2 N
  EXPECT_THAT(words_of(ridged(3e-4, 1e-3)).warnings,                    // swings by 4.0 N
              Contains(AllOf(HasSubstr("the hand of [hand] has 0.8 kg"),
                             HasSubstr("; it carries ridges of at most "))));
  for (const auto& [amplitude, period] :
       {std::pair{1.2e-3, 4e-3}, {4e-4, 2e-3}, {1e-4, 1e-3}, {2e-5, 5e-4}}) {
    EXPECT_THAT(words_of(ridged(amplitude, period)).warnings, Not(Contains(HasSubstr("carry"))))
        << amplitude;
  }
}

TEST(HandleTextTest, RidgesOfTheNamedHeightAreCarriedAndHigherOnesAreNot) {
  const double amplitude = 3e-4, period = 1e-3;
  const std::string warning = words_of(ridged(amplitude, period)).warnings.at(0);
  const auto at = warning.find("at most ");
  ASSERT_NE(at, std::string::npos);
  const double share = 0.01 * std::stod(warning.substr(at + 8));
  EXPECT_THAT(words_of(ridged(share * amplitude, period)).warnings, IsEmpty());
  EXPECT_THAT(words_of(ridged((share + 0.02) * amplitude, period)).warnings, Not(IsEmpty()));
}

// Hands that rest on such textures were calm in dry runs with up to 5.5 N: the crests of all waves
// do not meet.
TEST(HandleTextTest, ATextureIsCountedAsStiffAsItUsuallyIs) {
  for (const auto& [roughness, highest] :
       {std::pair{1e-4, 1000.0}, {2e-4, 1000.0}, {5e-5, 2000.0}}) {
    const std::string text =
        felt(R"("wall", "rough")",
             kWall + fmt::format("[fields.rough]\ntype = \"texture\"\non = \"wall\"\n"
                                 "normal = [0.0, 1.0, 0.0]\nroughness = {}\nlowest = 100.0\n"
                                 "highest = {}\nseed = 3\n",
                                 roughness, highest));
    EXPECT_THAT(problems_of_trials(text), IsEmpty()) << roughness;
    EXPECT_THAT(words_of(text).warnings, Not(Contains(HasSubstr("carry")))) << roughness;
  }
}

// F = limit / (1 + s): of 8 N, 2.77 N with s = 0.6 pi, 3.84 N with s = 0.345 pi and 6.09 N with
// s = 0.1 pi.
TEST(HandleTextTest, WhatRidgesLeaveOfALimitIsNamed) {
  const auto left = [](double amplitude) { return words_of(ridged(amplitude, 4e-3)); };
  EXPECT_THAT(left(1.2e-3).warnings,
              Contains(HasSubstr("ridges leave wall 2.77 N of its limit of 8 N")));
  EXPECT_THAT(left(6.9e-4).lines, Contains(HasSubstr("ridges leave wall 3.84 N")));
  for (const HandleText& words : {left(2e-4), words_of(felt(R"("wall")", kWall))}) {
    EXPECT_THAT(words.warnings, Not(Contains(HasSubstr("ridges leave"))));
    EXPECT_THAT(words.lines, Not(Contains(HasSubstr("ridges leave"))));
  }
}

// The force of 1000 N/m changes by 100 N/s for a hand of 0.1 m/s.
TEST(HandleTextTest, ALimitOfTheForcesRateThatAHandOutrunsIsWarnedOf) {
  const auto warnings = [](const char* rate) {
    return words_of(felt(R"("wall")", kWall + "[envelope]\nmax_force_rate = " + rate + "\n"))
        .warnings;
  };
  EXPECT_THAT(warnings("20.0"), ElementsAre(AllOf(HasSubstr("a hand of at most 0.02 m/s"),
                                                  HasSubstr("set it to 100 N/s or more"))));
  EXPECT_THAT(warnings("100.0"), IsEmpty());
}

// A body that moves hangs on the same spring of the hand as one that rests on every tick.
TEST(HandleTextTest, ABodyThatMovesIsAsStiffAsTheSpringOfTheHand) {
  const auto body = [](const char* model) {
    return problems_of_trials(
        felt(R"("body")", std::string("[objects.body]\nkind = \"deformable\"\nshape = \"box\"\n"
                                      "size = [0.04, 0.02, 0.04]\ncells = 4\nyoung = 1e7\n"
                                      "poisson = 0.4\ntool_radius = 0.005\nspring = 100000.0\n") +
                              model));
  };
  EXPECT_THAT(body(""), Contains(AllOf(HasSubstr("add up to 100000 N/m"),
                                       HasSubstr("no hand of up to 2 kg carries that"))));
  EXPECT_THAT(body("model = \"implicit\"\ndensity = 1000.0\n"),
              Contains(AllOf(HasSubstr("add up to 100000 N/m"),
                             HasSubstr("no hand of up to 2 kg carries that"))));
}

/// A study whose field or object f begins in the stage "feel", after a stage "wait".
/// @param until  ends the wait
std::string begun(const std::string& f, const std::string& until = "until = { time = 1.0 }") {
  const std::string stages = "[[stages]]\nname = \"wait\"\n" + until + "\n[[stages]]\n";
  return test::replaced(felt(R"("f")", f), "[[stages]]\n", stages);
}

std::vector<std::string> beginnings(const std::string& text) {
  std::vector<std::string> lines = words_of(text).lines;
  std::erase_if(lines, [](const std::string& line) {
    return line.find("may begin where the hand is") == std::string::npos;
  });
  return lines;
}

std::string push_of(const char* force) {
  return fmt::format("f may begin where the hand is, and then pushes it with up to {} N", force);
}

const std::string kSpring = "stiffness = 1000.0\ndamping = 5.0\nlimit = 7.5\n";

TEST(HandleTextTest, WhateverMayBeginAroundTheHandIsNamed) {
  for (const char* field : {
           "type = \"spring\"\nto = [0.05, 0.0, 0.0]\n",
           "type = \"plane\"\nthrough = [0.0, 0.05, 0.0]\nnormal = [0.0, 1.0, 0.0]\n",
           "type = \"channel\"\naxes = [\"x\"]\nthrough = [0.0, 0.05, 0.0]\n",
           "type = \"channel\"\nfrom = [0.0, 0.05, 0.0]\nto = [0.1, 0.05, 0.0]\n",
           "type = \"curve\"\npoints = [[0.05, 0.0, 0.0], [0.05, 0.0, 0.02]]\n",
           "type = \"path\"\npoints = [[0.05, 0.0, 0.0], [0.05, 0.0, 0.02]]\nduration = 2.0\n",
           "type = \"box\"\ncentre = [0.0, 0.0, 0.0]\nsize = [0.06, 0.06, 0.06]\n",
       }) {
    EXPECT_THAT(beginnings(begun("[fields.f]\n" + std::string(field) + kSpring)),
                ElementsAre(AllOf(HasSubstr("stage feel: fields." + push_of("7.5")),
                                  HasSubstr("which come within 0.05 s"))))
        << field;
  }
  EXPECT_THAT(beginnings(begun("[objects.f]\nshape = \"sphere\"\nradius = 0.03\n"
                               "centre = [0.0, -0.005, 0.0]\n" +
                               kSpring)),
              ElementsAre(HasSubstr("stage feel: objects." + push_of("7.5"))));
  // The force of these is what the definition asks for, or begins where the hand is.
  for (const char* meant : {"type = \"constant\"\nforce = [2.0, 0.0, 0.0]\n",
                            "type = \"minimum_jerk\"\nto = [0.05, 0.0, 0.0]\nduration = 1.0\n"
                            "stiffness = 300.0\ndamping = 5.0\n",
                            "type = \"vibration\"\ndirection = [1.0, 0.0, 0.0]\namplitude = "
                            "2.0\nfrequency = 40.0\nphase = 1.0\n"}) {
    EXPECT_THAT(beginnings(begun("[fields.f]\n" + std::string(meant))), IsEmpty()) << meant;
  }
}

// In the middle of a box of 6 cm a hand is 3 cm deep: 100 N/m give 3 N, and 30 N more than the
// device.
TEST(HandleTextTest, APushIsThatOfTheDeepestPlaceAndOfTheDevice) {
  const auto box = [](const char* stiffness) {
    return std::string(
               "[objects.f]\nshape = \"box\"\nsize = [0.06, 0.06, 0.06]\n"
               "damping = 5.0\nlimit = 40.0\nstiffness = ") +
           stiffness + "\n";
  };
  EXPECT_THAT(beginnings(begun(box("100.0"))), ElementsAre(HasSubstr(push_of("3"))));
  EXPECT_THAT(beginnings(begun(box("1000.0"))), ElementsAre(HasSubstr(push_of("8"))));
}

// The wall begins 5 cm below the hand, or 3 cm above a hand at the origin.
TEST(HandleTextTest, TheHardestPushOfAllLevelsIsNamed) {
  const auto wall = [](const char* levels) {
    return begun(
        "[fields.f]\ntype = \"wall\"\npoint = [0.0, \"$h\", 0.0]\n"
        "normal = [0.0, 1.0, 0.0]\n" +
        kSpring + "[factors]\nh = [" + levels + "]\n");
  };
  EXPECT_THAT(beginnings(wall("-0.2, 0.03")), ElementsAre(HasSubstr(push_of("7.5"))));
  EXPECT_EQ(beginnings(wall("-0.2, 0.03")), beginnings(wall("0.03, -0.2")));
}

// A hand that waits in a ball of 3 mm is at most that far from its middle, unless the wait may end
// without it, or the ball is the cursor's.
TEST(HandleTextTest, AHandIsWhereTheStageBeforeWaitsForIt) {
  const std::string spring =
      "[fields.f]\ntype = \"spring\"\nto = [0.013, 0.002, 0.0]\nstiffness = 1000.0\n"
      "damping = 5.0\nlimit = 7.5\n[regions.start]\ntype = \"sphere\"\ncentre = [0.013, 0.002, "
      "0.0]\n"
      "radius = 0.003\n";
  const std::string until = "until = { inside = \"start\" }\ntimeout = { after = 5.0, then = ";
  EXPECT_THAT(beginnings(begun(spring, until + "\"abort\" }")),
              ElementsAre(HasSubstr(push_of("3"))));
  EXPECT_THAT(beginnings(begun(spring, until + "\"go on\" }")),
              ElementsAre(HasSubstr(push_of("7.5"))));
  EXPECT_THAT(beginnings(begun(spring + "of = \"cursor\"\n[cursor]\n", until + "\"abort\" }")),
              ElementsAre(HasSubstr(push_of("7.5"))));
}

}  // namespace
}  // namespace haptrial::protocols::handle_text_test
