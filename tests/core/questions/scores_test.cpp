#include "core/questions/scores.h"

#include <gtest/gtest.h>

#include <array>
#include <limits>
#include <map>
#include <string>

#include "core/questions/known_questionnaires.h"

namespace haptrial::questions {
namespace {

using Ratings = std::array<double, 6>;

/// Ratings in the order of kTlxScales, and pairs that give each scale its weight: the scale with
/// more choices still to get wins.
std::vector<GivenAnswer> filled(const Ratings& ratings, std::map<std::string, int> weights) {
  std::vector<GivenAnswer> answers;
  for (std::size_t i = 0; i < ratings.size(); ++i) {
    answers.push_back({kTlxScales[i], ratings[i], ""});
  }
  for (const questions::Question& item : nasa_tlx_items(true)) {
    if (!item.choices.empty()) {
      const bool first = weights[item.choices[0].value] >= weights[item.choices[1].value];
      const std::string chosen = item.choices[first ? 0 : 1].value;
      answers.push_back({item.name, first ? 1.0 : 2.0, chosen});
    }
  }
  return answers;
}

std::map<std::string, int> tally(const std::vector<GivenAnswer>& answers) {
  std::map<std::string, int> weights;
  for (const GivenAnswer& answer : answers) {
    weights[answer.text] += answer.text.empty() ? 0 : 1;
  }
  return weights;
}

TEST(TlxTest, AsksEveryPairOfScalesOnce) {
  EXPECT_EQ(nasa_tlx_items(false).size(), 6u);
  std::map<std::string, int> asked;
  int pairs = 0;
  for (const questions::Question& item : nasa_tlx_items(true)) {
    if (!item.choices.empty()) {
      ++pairs;
      for (const questions::Choice& choice : item.choices) {
        ++asked[choice.value];
      }
    }
  }
  EXPECT_EQ(pairs, 15);
  for (const char* scale : kTlxScales) {
    EXPECT_EQ(asked[scale], 5) << scale;
  }
}

// The expected score by hand, with the rule of the manual (Hart 1986, section 2.4): ratings 30, 15,
// 60, 40, 40, 30 of mental, physical, temporal, performance, effort, frustration with the weights
// 3, 0, 5, 1, 3, 3: (90 + 0 + 300 + 40 + 120 + 90) / 15 = 42.67.
TEST(TlxTest, WeighsRatingsByTheChoicesOfThePairs) {
  std::vector<GivenAnswer> answers = filled({30, 15, 60, 40, 40, 30}, {});
  const std::map<std::string, std::string> chosen{
      {"mental or physical", "mental"},           {"mental or temporal", "temporal"},
      {"mental or performance", "mental"},        {"mental or effort", "effort"},
      {"mental or frustration", "mental"},        {"physical or temporal", "temporal"},
      {"physical or performance", "performance"}, {"physical or effort", "effort"},
      {"physical or frustration", "frustration"}, {"temporal or performance", "temporal"},
      {"temporal or effort", "temporal"},         {"temporal or frustration", "temporal"},
      {"performance or effort", "effort"},        {"performance or frustration", "frustration"},
      {"effort or frustration", "frustration"}};
  for (GivenAnswer& answer : answers) {
    if (const auto found = chosen.find(answer.item); found != chosen.end()) {
      answer.text = found->second;
    }
  }
  const std::map<std::string, int> weights = tally(answers);
  ASSERT_EQ(weights.at("mental"), 3);
  ASSERT_EQ(weights.at("temporal"), 5);
  ASSERT_EQ(weights.at("performance"), 1);
  ASSERT_EQ(weights.at("effort"), 3);
  ASSERT_EQ(weights.at("frustration"), 3);
  ASSERT_FALSE(weights.contains("physical"));
  EXPECT_NEAR(tlx_weighted(answers).value(), 640.0 / 15.0, 1e-12);
  EXPECT_NEAR(tlx_raw(answers).value(), 215.0 / 6.0, 1e-12);
}

TEST(TlxTest, EqualRatingsAreTheScoreWhateverTheWeights) {
  for (const double rating : {0.0, 35.0, 100.0}) {
    const auto answers = filled({rating, rating, rating, rating, rating, rating}, {{"effort", 5}});
    EXPECT_NEAR(tlx_raw(answers).value(), rating, 1e-12);
    EXPECT_NEAR(tlx_weighted(answers).value(), rating, 1e-12);
  }
}

TEST(TlxTest, HasNoScoreWhileAnswersAreMissing) {
  auto answers = filled({1, 2, 3, 4, 5, 6}, {});
  answers.pop_back();
  EXPECT_FALSE(tlx_weighted(answers));
  EXPECT_TRUE(tlx_raw(answers));
  answers.erase(answers.begin());
  EXPECT_FALSE(tlx_raw(answers));
}

/// Answers to the first activities in their order.
double quotient(const std::vector<double>& values) {
  std::vector<GivenAnswer> answers;
  const std::vector<questions::Question> items = edinburgh_items();
  for (std::size_t i = 0; i < values.size(); ++i) {
    answers.push_back({items.at(i).name, values[i], ""});
  }
  return laterality_quotient(answers).value();
}

TEST(EdinburghTest, HasTenActivities) { EXPECT_EQ(edinburgh_items().size(), 10u); }

// Oldfield 1971, p. 99 and 112: 100 (R - L) / (R + L) over the plus signs.
TEST(EdinburghTest, CountsPlusSigns) {
  const std::vector<double> always(10, 2.0);
  EXPECT_EQ(quotient(always), 100.0);
  EXPECT_EQ(quotient(std::vector<double>(10, 1.0)), 100.0) << "one plus each is as one-sided";
  EXPECT_EQ(quotient(std::vector<double>(10, -2.0)), -100.0);
  EXPECT_EQ(quotient(std::vector<double>(10, 0.0)), 0.0) << "a plus in both columns";
  // R: 2 + 2 + 1 + 1 (either), L: 1 (either) + 1: 100 (6 - 2) / 8.
  EXPECT_DOUBLE_EQ(quotient({2, 2, 1, 0, -1}), 50.0);
}

TEST(EdinburghTest, LeavesOutWhatWasNeverDone) {
  const double never = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(quotient({2, never, never, -1}), 100.0 * (2 - 1) / 3);
  EXPECT_FALSE(laterality_quotient({{"writing", never, "never done"}}));
  EXPECT_FALSE(laterality_quotient({}));
}

}  // namespace
}  // namespace haptrial::questions
