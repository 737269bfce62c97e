#include "protocols/definition/schedule.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <set>
#include <sstream>

#include "core/base/definition/schema.h"
#include "core/base/error.h"

namespace haptrial::protocols {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

Design published() {
  Design d;
  d.conditions = {"haptic", "visual", "visuohaptic"};
  return d;
}

TEST(WilliamsTest, EveryConditionStandsAtEveryPlaceEquallyOften) {
  for (int n = 1; n <= 7; ++n) {
    const auto rows = williams_rows(n);
    EXPECT_EQ(rows.size(), static_cast<std::size_t>(n % 2 == 0 || n == 1 ? n : 2 * n)) << n;
    std::map<std::pair<int, int>, int> at_place;
    for (const auto& row : rows) {
      ASSERT_EQ(row.size(), static_cast<std::size_t>(n));
      for (int place = 0; place < n; ++place) {
        ++at_place[{row[place], place}];
      }
    }
    ASSERT_EQ(at_place.size(), static_cast<std::size_t>(n * n)) << n;
    for (const auto& [where, count] : at_place) {
      EXPECT_EQ(count, static_cast<int>(rows.size()) / n) << n;
      EXPECT_TRUE(where.first >= 0 && where.first < n);
    }
  }
}

TEST(WilliamsTest, EveryConditionFollowsEveryOtherEquallyOften) {
  for (int n = 2; n <= 7; ++n) {
    std::map<std::pair<int, int>, int> pairs;
    const auto rows = williams_rows(n);
    for (const auto& row : rows) {
      for (int place = 1; place < n; ++place) {
        ++pairs[{row[place - 1], row[place]}];
      }
    }
    ASSERT_EQ(pairs.size(), static_cast<std::size_t>(n * (n - 1))) << n;
    for (const auto& [pair, count] : pairs) {
      EXPECT_EQ(count, static_cast<int>(rows.size()) / n) << n;
      EXPECT_NE(pair.first, pair.second);
    }
  }
}

TEST(PlanTest, ThePublishedDesignHasTwentyFourBlocksOfThree) {
  for (int participant = 0; participant < 12; ++participant) {
    const auto plan = plan_trials(published(), participant, 1, 100 + participant);
    ASSERT_EQ(plan.size(), 72u);
    std::map<std::string, std::set<int>> blocks;
    for (std::size_t i = 0; i < plan.size(); ++i) {
      EXPECT_EQ(plan[i].trial, static_cast<int>(i) + 1);
      EXPECT_EQ(plan[i].block, static_cast<int>(i) / 3 + 1);
      EXPECT_EQ(plan[i].repetition, static_cast<int>(i) % 3 + 1);
      EXPECT_EQ(plan[i].condition, plan[i / 3 * 3].condition) << "one condition a block";
      blocks[plan[i].condition].insert(plan[i].block);
    }
    ASSERT_EQ(blocks.size(), 3u);
    for (const auto& [condition, of_it] : blocks) {
      EXPECT_EQ(of_it.size(), 8u) << condition;
    }
  }
}

TEST(PlanTest, EveryGroupOfBlocksHoldsEachConditionOnce) {
  const auto plan = plan_trials(published(), 5, 1, 2);
  for (std::size_t group = 0; group < 8; ++group) {
    std::set<std::string> conditions;
    for (std::size_t trial = 9 * group; trial < 9 * group + 9; ++trial) {
      conditions.insert(plan[trial].condition);
    }
    EXPECT_EQ(conditions.size(), 3u) << group;
  }
}

TEST(PlanTest, SixConsecutiveParticipantsUseEveryOrderOnceInEveryGroup) {
  for (const int first : {0, 1, 4, 6}) {
    for (std::size_t group = 0; group < 8; ++group) {
      std::set<std::vector<std::string>> orders;
      for (int participant = first; participant < first + 6; ++participant) {
        const auto plan = plan_trials(published(), participant, 77, 1000 + participant);
        std::vector<std::string> order;
        for (std::size_t block = 0; block < 3; ++block) {
          order.push_back(plan[9 * group + 3 * block].condition);
        }
        orders.insert(order);
      }
      EXPECT_EQ(orders.size(), 6u) << "all orders of three, group " << group << " from " << first;
    }
  }
}

TEST(PlanTest, OrdersDifferBetweenGroupsAndStudies) {
  const auto order = [](std::uint64_t study) {
    std::string text;
    for (const auto& trial : plan_trials(published(), 0, study, 5)) {
      text += trial.condition[0] + std::to_string(trial.condition.size());
    }
    return text;
  };
  std::set<std::string> studies;
  for (std::uint64_t study = 0; study < 20; ++study) {
    studies.insert(order(study));
  }
  EXPECT_EQ(studies.size(), 20u) << "6^8 orders: two alike would be no accident";
  const std::string one = order(1);
  EXPECT_NE(one.substr(0, one.size() / 2), one.substr(one.size() / 2));
}

TEST(PlanTest, StimulusSeedsAreOneABlockAndNeverTheSameTwice) {
  std::set<std::uint64_t> seeds;
  for (int participant = 0; participant < 12; ++participant) {
    const auto plan = plan_trials(published(), participant, 1, 100 + participant);
    for (const auto& trial : plan) {
      EXPECT_EQ(trial.stimulus_seed, plan[3 * (trial.block - 1)].stimulus_seed);
      seeds.insert(trial.stimulus_seed);
    }
  }
  EXPECT_EQ(seeds.size(), 12u * 24u);
}

TEST(PlanTest, IsAFunctionOfItsArguments) {
  const auto a = plan_trials(published(), 3, 10, 20);
  const auto b = plan_trials(published(), 3, 10, 20);
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i) {
    EXPECT_EQ(a[i].condition, b[i].condition);
    EXPECT_EQ(a[i].stimulus_seed, b[i].stimulus_seed);
  }
}

TEST(PlanTest, OneConditionNeedsNoBalance) {
  Design d;
  d.conditions = {"visual"};
  d.trials = 4;
  d.repetitions = 2;
  const auto plan = plan_trials(d, 0, 1, 2);
  ASSERT_EQ(plan.size(), 4u);
  EXPECT_NE(plan[0].stimulus_seed, plan[2].stimulus_seed);
}

class DesignTest : public ::testing::Test {
 protected:
  /// Sentences about the published design when `from` is replaced by `to`.
  static std::vector<std::string> problems(const std::string& from, const std::string& to) {
    std::string text =
        "participants = 12\ntrials = 72\nrepetitions = 3\nbreak_after = 36\n"
        "break_duration = 600.0\nconditions = [\"haptic\", \"visual\", \"visuohaptic\"]\n";
    text.replace(text.find(from), from.size(), to);
    Table table = Table::parse(text, "d.toml");
    design_schema().read(table);
    try {
      table.finish();
    } catch (const InputError& error) {
      std::istringstream in(error.what());
      std::vector<std::string> lines;
      for (std::string line; std::getline(in, line);) {
        lines.push_back(line);
      }
      return lines;
    }
    return {};
  }
};

TEST_F(DesignTest, ThePublishedDesignIsGood) {
  EXPECT_THAT(problems("36", "36"), ElementsAre());
  EXPECT_THAT(problems("36", "0"), ElementsAre());
}

TEST_F(DesignTest, TrialsThatDoNotDivideAreRefused) {
  EXPECT_THAT(problems("trials = 72", "trials = 70"),
              ElementsAre("d.toml:2: trials is 70; allowed: a multiple of 9 (3 repetitions of 3 "
                          "conditions)"));
}

TEST_F(DesignTest, ABreakWithinABlockOrAfterTheEndIsRefused) {
  EXPECT_THAT(problems("36", "37"), ElementsAre("d.toml:4: break_after is 37; allowed: a multiple "
                                                "of the 3 repetitions of a block"));
  EXPECT_THAT(problems("36", "72"),
              ElementsAre("d.toml:4: break_after is 72; allowed: a whole number below the 72 "
                          "trials, or 0 for no break"));
}

TEST_F(DesignTest, ABreakMayLastUntilSomebodyIsReady) {
  const std::string line = "break_duration = 600.0\n";
  EXPECT_THAT(problems(line, line + "break_until = \"ready\"\n"), ElementsAre());
  EXPECT_THAT(problems(line, line + "break_until = \"red\"\n"),
              ElementsAre(HasSubstr("d.toml:6: break_until is 'red'")));
  EXPECT_THAT(problems("36\n" + line, "0\n" + line + "break_until = \"ready\"\n"),
              ElementsAre("d.toml:6: break_until is \"ready\", but there are no breaks; add "
                          "break_after, a number of trials"));
}

TEST_F(DesignTest, AConditionNamedTwiceIsRefused) {
  EXPECT_THAT(
      problems("\"haptic\"", "\"visual\""),
      ElementsAre("d.toml:6: conditions names a condition twice; name each condition once"));
}

TEST_F(DesignTest, AMissingKeyIsTheOnlyProblem) {
  for (const char* key : {"participants = 12\n", "trials = 72\n", "repetitions = 3\n",
                          "break_after = 36\n", "break_duration = 600.0\n"}) {
    const auto found = problems(key, "");
    ASSERT_EQ(found.size(), 1u) << key << found.back();
    EXPECT_THAT(found[0], HasSubstr(" is missing; allowed: "));
  }
}

}  // namespace
}  // namespace haptrial::protocols
