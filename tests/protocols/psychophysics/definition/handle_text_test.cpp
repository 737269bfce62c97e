// Demands of a stage's fields on hands: what is refused, warned of and named before anybody comes.

#include "protocols/psychophysics/definition/handle_text.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "protocols/psychophysics/definition/every_value.h"
#include "tests/protocols/psychophysics/definition/small_definition.h"

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
  // 0.12 of 8 N are less than what counts as an oscillation.
  EXPECT_THAT(rubbing("on = \"wall\"\nstatic = 0.12\ndynamic = 0.1\n", 1e5), IsEmpty());
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

}  // namespace
}  // namespace haptrial::protocols::handle_text_test
