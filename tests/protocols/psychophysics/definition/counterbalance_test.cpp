#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <stdexcept>

#include "core/base/error.h"
#include "core/base/random.h"
#include "protocols/psychophysics/definition/counterbalance.h"

namespace haptrial::protocols {
namespace {

constexpr std::uint64_t kStudy = 7;

std::vector<int> order_for(Counterbalancing balance, int levels, int participant) {
  return order_of_levels(balance, levels, participant, kStudy,
                         1000U + static_cast<std::uint64_t>(participant));
}

class BalancedTest : public testing::TestWithParam<Counterbalancing> {};

TEST_P(BalancedTest, OverOneRoundEachLevelIsAtEachPlaceEquallyOften) {
  for (int levels = 1; levels <= 6; ++levels) {
    const auto round = static_cast<int>(participants_for(GetParam(), levels));
    for (const int first : {0, round}) {  // the second round as well
      std::map<std::pair<int, int>, int> at;
      for (int p = first; p < first + round; ++p) {
        const std::vector<int> order = order_for(GetParam(), levels, p);
        ASSERT_EQ(std::set<int>(order.begin(), order.end()).size(),
                  static_cast<std::size_t>(levels));
        for (std::size_t place = 0; place < order.size(); ++place) {
          ++at[{static_cast<int>(place), order[place]}];
        }
      }
      for (const auto& [where, count] : at) {
        EXPECT_EQ(count, round / levels) << levels << " levels";
      }
    }
  }
}

INSTANTIATE_TEST_SUITE_P(All, BalancedTest,
                         testing::Values(Counterbalancing::kLatin, Counterbalancing::kWilliams,
                                         Counterbalancing::kFull));

TEST(CounterbalanceTest, AFullRoundHasEveryOrderOnce) {
  std::set<std::vector<int>> orders;
  for (int p = 0; p < 24; ++p) {
    orders.insert(order_for(Counterbalancing::kFull, 4, p));
  }
  EXPECT_EQ(orders.size(), 24U);
}

TEST(CounterbalanceTest, WhichOrderComesToWhomFollowsFromTheStudysSeed) {
  std::set<std::vector<int>> of_the_first;
  for (std::uint64_t study = 0; study < 60; ++study) {
    of_the_first.insert(order_of_levels(Counterbalancing::kLatin, 4, 0, study, 1));
    EXPECT_EQ(order_of_levels(Counterbalancing::kLatin, 4, 3, study, 1),
              order_of_levels(Counterbalancing::kLatin, 4, 3, study, 2))
        << "not from the participant's";
  }
  EXPECT_EQ(of_the_first.size(), 4U);
}

TEST(CounterbalanceTest, FixedIsAsListedAndRandomDiffers) {
  EXPECT_EQ(order_for(Counterbalancing::kFixed, 3, 5), (std::vector<int>{0, 1, 2}));
  std::map<std::vector<int>, int> drawn;
  constexpr int kPeople = 6000;
  for (int p = 0; p < kPeople; ++p) {
    ++drawn[order_for(Counterbalancing::kRandom, 3, p)];
  }
  ASSERT_EQ(drawn.size(), 6U);
  double chi_squared = 0.0;
  for (const auto& [order, count] : drawn) {
    chi_squared += (count - kPeople / 6.0) * (count - kPeople / 6.0) / (kPeople / 6.0);
  }
  EXPECT_LT(chi_squared, 20.5) << "5 degrees of freedom, p 0.001";
}

TEST(CounterbalanceTest, NamesAndLimits) {
  EXPECT_EQ(balance_named("williams"), Counterbalancing::kWilliams);
  EXPECT_THROW(balance_named("latin square"), std::invalid_argument);
  EXPECT_THROW(participants_for(Counterbalancing::kFull, 9), std::invalid_argument);
  EXPECT_THROW(participants_for(Counterbalancing::kLatin, 0), std::invalid_argument);
  EXPECT_EQ(participants_for(Counterbalancing::kWilliams, 3), 6);
  EXPECT_EQ(participants_for(Counterbalancing::kWilliams, 4), 4);
}

std::vector<int> in_order(const std::vector<int>& values, const std::vector<std::size_t>& order) {
  std::vector<int> result;
  for (const std::size_t trial : order) {
    result.push_back(values[trial]);
  }
  return result;
}

int longest_run(const std::vector<int>& values, int value) {
  int longest = 0;
  int run = 0;
  for (const int each : values) {
    run = each == value ? run + 1 : 0;
    longest = std::max(longest, run);
  }
  return longest;
}

TEST(ConstrainedOrderTest, EveryRuleIsKept) {
  std::vector<int> condition, kind;
  for (int k = 0; k < 96; ++k) {
    condition.push_back(k % 3);
    kind.push_back(k % 8 == 0 ? 1 : 0);  // catch trials
  }
  const std::vector<OrderRule> rules{{"condition", condition, 2}, {"catch", kind, 1, 1, 8}};
  for (std::uint64_t seed = 0; seed < 50; ++seed) {
    RandomStream random(seed, "order");
    const std::vector<std::size_t> order = constrained_order(96, rules, random);
    std::vector<std::size_t> sorted = order;
    std::ranges::sort(sorted);
    for (std::size_t k = 0; k < sorted.size(); ++k) {
      ASSERT_EQ(sorted[k], k) << "each trial once";
    }
    const std::vector<int> conditions = in_order(condition, order);
    for (const int value : {0, 1, 2}) {
      EXPECT_LE(longest_run(conditions, value), 2);
    }
    const std::vector<int> kinds = in_order(kind, order);
    EXPECT_EQ(longest_run(kinds, 1), 1);
    EXPECT_EQ(std::count(kinds.begin(), kinds.begin() + 8, 1), 0) << "none in the first cycle";
  }
}

/// Five of one and three of another value, at most two in a row: counted by hand in the loop below.
TEST(ConstrainedOrderTest, EveryOrderThatIsAllowedComesAboutEquallyOften) {
  const std::vector<int> values{0, 0, 0, 0, 0, 1, 1, 1};
  std::vector<int> pattern = values;
  std::map<std::vector<int>, int> seen;
  do {
    if (longest_run(pattern, 0) <= 2 && longest_run(pattern, 1) <= 2) {
      seen[pattern] = 0;
    }
  } while (std::ranges::next_permutation(pattern).found);
  const std::vector<OrderRule> rules{{"value", values, 2}};
  constexpr int kDrawn = 20000;
  RandomStream random(3, "order");
  for (int k = 0; k < kDrawn; ++k) {
    const auto found = seen.find(in_order(values, constrained_order(8, rules, random)));
    ASSERT_NE(found, seen.end());
    ++found->second;
  }
  const double expected = static_cast<double>(kDrawn) / static_cast<double>(seen.size());
  for (const auto& [order, count] : seen) {
    EXPECT_NEAR(count, expected, 0.35 * expected) << testing::PrintToString(order);
  }
}

TEST(ConstrainedOrderTest, WithoutRulesItIsAShuffle) {
  std::map<std::vector<std::size_t>, int> seen;
  RandomStream random(5, "order");
  constexpr int kDrawn = 6000;
  for (int k = 0; k < kDrawn; ++k) {
    ++seen[constrained_order(3, {}, random)];
  }
  ASSERT_EQ(seen.size(), 6U);
  for (const auto& [order, count] : seen) {
    EXPECT_NEAR(count, kDrawn / 6.0, 5.0 * std::sqrt(kDrawn / 6.0));
  }
}

TEST(ConstrainedOrderTest, AnImpossibleRuleIsNamed) {
  const std::vector<OrderRule> rules{{"side", {0, 0, 0, 1}, 1}};
  RandomStream random(1, "order");
  EXPECT_THAT([&] { constrained_order(4, rules, random); },
              testing::ThrowsMessage<InputError>(
                  testing::HasSubstr("no order of 4 trials was found that keeps the rules about "
                                     "side")));
  EXPECT_THROW(constrained_order(5, rules, random), std::invalid_argument);
}

}  // namespace
}  // namespace haptrial::protocols
