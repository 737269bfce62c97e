#include "protocols/psychophysics/definition/counterbalance.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <set>
#include <stdexcept>

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

}  // namespace
}  // namespace haptrial::protocols
