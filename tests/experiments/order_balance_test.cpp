#include "analysis/force_training/study/order_balance.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "protocols/definition/schedule.h"

namespace haptrial::analysis {
namespace {

using testing::HasSubstr;

const std::vector<std::string> kConditions{"haptic", "visual", "visuohaptic"};

/// The scores of a study that was run as the schedule says.
std::vector<TrialScore> scheduled(int participants) {
  protocols::Design design;
  design.conditions = kConditions;
  std::vector<TrialScore> scores;
  for (int p = 0; p < participants; ++p) {
    for (const auto& trial :
         protocols::plan_trials(design, p, 7, 100 + static_cast<std::uint64_t>(p))) {
      TrialScore score;
      score.subject = fmt::format("S{}", p);
      score.condition = trial.condition;
      score.trial = trial.trial;
      score.block = trial.block;
      score.repetition = trial.repetition;
      scores.push_back(score);
    }
  }
  return scores;
}

TEST(OrderBalance, SixOrTwelveParticipantsBalanceThreeConditions) {
  for (const int participants : {6, 12}) {
    const OrderBalance balance = order_balance(scheduled(participants), kConditions);
    EXPECT_TRUE(balance.places_balanced()) << participants;
    EXPECT_TRUE(balance.sequences_balanced()) << participants;
    // 8 groups of blocks for each participant; each condition at each of 3 places.
    EXPECT_THAT(sentence_of(balance),
                HasSubstr(fmt::format("came {} times at each place", 8 * participants / 3)));
  }
}

TEST(OrderBalance, SevenDoNotAndTheCountsAreSaid) {
  const OrderBalance balance = order_balance(scheduled(7), kConditions);
  EXPECT_TRUE(balance.grouped);
  EXPECT_FALSE(balance.places_balanced());
  EXPECT_THAT(sentence_of(balance), HasSubstr("Order is not balanced"));
  for (const auto& row : balance.at_place) {
    EXPECT_EQ(row[0] + row[1] + row[2], 56u);
  }
}

TEST(OrderBalance, TheOrderOfRowsDoesNotMatter) {
  auto scores = scheduled(6);
  std::reverse(scores.begin(), scores.end());
  EXPECT_TRUE(order_balance(scores, kConditions).places_balanced());
}

TEST(OrderBalance, BlocksWithoutNumbersCannotBeChecked) {
  auto scores = scheduled(6);
  for (auto& score : scores) {
    score.block = 1;
  }
  const OrderBalance balance = order_balance(scores, kConditions);
  EXPECT_FALSE(balance.grouped);
  EXPECT_FALSE(balance.places_balanced());
  EXPECT_THAT(sentence_of(balance), HasSubstr("cannot be checked"));
  EXPECT_FALSE(order_balance({}, kConditions).grouped);
}

TEST(OrderBalance, OneConditionAfterTheOtherIsNotInGroups) {
  auto scores = scheduled(6);
  std::stable_sort(scores.begin(), scores.end(), [](const auto& a, const auto& b) {
    return a.subject != b.subject ? a.subject < b.subject : a.condition < b.condition;
  });
  for (std::size_t i = 0; i < scores.size(); ++i) {
    scores[i].trial = static_cast<std::int32_t>(i % 72) + 1;
  }
  EXPECT_FALSE(order_balance(scores, kConditions).grouped);
}

}  // namespace
}  // namespace haptrial::analysis
