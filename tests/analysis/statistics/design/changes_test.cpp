// Changes of participants from one level to others, and what compares them between groups.

#include "analysis/statistics/design/compared_sides.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "analysis/statistics/design/design_tests.h"
#include "core/base/random.h"

namespace haptrial::analysis {
namespace {

using testing::ElementsAre;

std::vector<Observation> study(std::uint64_t seed, int in_each_group, double effect) {
  std::vector<Observation> all;
  RandomStream random(seed, "study");
  for (int person = 0; person < 2 * in_each_group; ++person) {
    const bool trained = person < in_each_group;
    const std::string name = fmt::format("P{:02}", person);
    const std::string group = trained ? "trained" : "control";
    const double own = 3.0 * random.normal();  // between participants
    all.push_back({name, {group, "pre"}, own + random.normal()});
    all.push_back({name, {group, "post"}, own + random.normal() + (trained ? effect : 0.0) + 0.7});
  }
  return all;
}

Resampling no_resampling() {
  Resampling none;
  none.count = 0;
  return none;
}

SideTest planned_test(const std::vector<Observation>& all) {
  const DesignTable table = design_table(changes_from(all, 1, "pre"), {"group", "change"});
  const AnalysisPlan plan = parse_analysis_plan({"trained != control"}, "", "test");
  return design_tests(table, plan, no_resampling()).planned.tests.front();
}

TEST(ChangesTest, AreOfMeansAndOfThoseWhoHaveTheBaseline) {
  const std::vector<Observation> all{{"A", {"x", "pre"}, 1.0},  {"A", {"x", "pre"}, 3.0},
                                     {"A", {"x", "post"}, 7.0}, {"A", {"x", "later"}, 2.0},
                                     {"B", {"y", "post"}, 9.0}, {"C", {"y", "pre"}, 9.0}};
  std::vector<std::string> found;
  for (const Observation& each : changes_from(all, 1, "pre")) {
    found.push_back(
        fmt::format("{} {} {} {:g}", each.subject, each.levels[0], each.levels[1], each.value));
  }
  EXPECT_THAT(found, ElementsAre("A x later 0", "A x post 5"));
}

/// With groups of one size Welch's t of changes is the root of F of group by session in the mixed
/// analysis of variance, which knows nothing of changes.
TEST(ChangesTest, TheirTestIsTheInteractionOfGroupAndSession) {
  const std::vector<Observation> all = study(3, 9, 1.5);
  const DesignTable whole = design_table(all, {"group", "session"}, {"pre", "post"});
  const auto effects = design_effects(whole);
  ASSERT_EQ(effects.size(), 3u);
  ASSERT_TRUE(effects[2]);
  EXPECT_EQ(effects[2]->factor, "group × session");
  const SideTest test = planned_test(all);
  ASSERT_TRUE(test.t);
  EXPECT_NEAR(test.t->t * test.t->t, effects[2]->f, 1e-9 * effects[2]->f);
}

/// Where nobody learns more than others, one in twenty studies says so: in 97 of 100 counts of 400
/// studies 12 to 30.
TEST(ChangesTest, AStudyWithoutAnEffectFindsOneInOneOfTwenty) {
  int found = 0;
  for (std::uint64_t seed = 1; seed <= 400; ++seed) {
    found += planned_test(study(seed, 6, 0.0)).t->p < 0.05 ? 1 : 0;
  }
  EXPECT_GE(found, 12);
  EXPECT_LE(found, 30);
  EXPECT_LT(planned_test(study(1, 20, 3.0)).t->p, 1e-5) << "an effect is found";
}

}  // namespace
}  // namespace haptrial::analysis
