#include "protocols/psychophysics/definition/constrained_order.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "core/base/error.h"
#include "core/base/random.h"

namespace haptrial::protocols {
namespace {

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
