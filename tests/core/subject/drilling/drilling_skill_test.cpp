#include "core/subject/drilling/drilling_skill.h"

#include <gtest/gtest.h>

#include <cmath>

namespace haptrial::subject {
namespace {

TEST(DrillingSkillTest, TheEndsHaveThePublishedFigures) {
  EXPECT_DOUBLE_EQ(drilling_skill(1.0).near_force, 0.13);
  EXPECT_DOUBLE_EQ(drilling_skill(0.0).near_force, 0.24);
  EXPECT_DOUBLE_EQ(drilling_skill(1.0).stroke_rate, 1.4);
}

TEST(DrillingSkillTest, EveryFieldIsALine) {
  const DrillingSkill low = drilling_skill(0.0);
  const DrillingSkill middle = drilling_skill(0.5);
  const DrillingSkill high = drilling_skill(1.0);
  // All fields are doubles.
  constexpr std::size_t kFields = sizeof(DrillingSkill) / sizeof(double);
  const auto* a = reinterpret_cast<const double*>(&low);
  const auto* b = reinterpret_cast<const double*>(&middle);
  const auto* c = reinterpret_cast<const double*>(&high);
  for (std::size_t f = 0; f < kFields; ++f) {
    EXPECT_NEAR(b[f], 0.5 * (a[f] + c[f]), 1e-12) << "field " << f;
    EXPECT_NE(a[f], c[f]) << "field " << f << " does not depend on skill";
  }
}

TEST(DrillingSkillTest, SkillVariesAsSaidAndAParticipantKeepsTheirs) {
  SkillSpread spread;
  spread.learning = 0.0;
  constexpr int kPeople = 4000;
  double sum = 0.0;
  double squares = 0.0;
  double within = 0.0;
  for (std::uint64_t seed = 1; seed <= kPeople; ++seed) {
    const double first = skill_in(0.5, spread, seed, 0);
    const double second = skill_in(0.5, spread, seed, 1);
    sum += first;
    squares += (first - 0.5) * (first - 0.5);
    within += (second - first) * (second - first);
    EXPECT_EQ(first, skill_in(0.5, spread, seed, 0));
  }
  const double whole = std::hypot(spread.between, spread.within);
  EXPECT_NEAR(sum / kPeople, 0.5, 4.0 * whole / std::sqrt(kPeople));
  EXPECT_NEAR(std::sqrt(squares / kPeople), whole, 0.05 * whole);
  EXPECT_NEAR(std::sqrt(within / kPeople), spread.within * std::sqrt(2.0), 0.05 * spread.within);
}

TEST(DrillingSkillTest, ASecondProcedureTeachesAShareOfWhatIsMissing) {
  const SkillSpread spread{0.0, 0.0, 0.1};
  EXPECT_DOUBLE_EQ(skill_in(0.2, spread, 1, 0), 0.2);
  EXPECT_DOUBLE_EQ(skill_in(0.2, spread, 1, 1), 0.28);
  EXPECT_DOUBLE_EQ(skill_in(1.0, spread, 1, 1), 1.0);
}

}  // namespace
}  // namespace haptrial::subject
