#include "core/psychometric/procedure/pest.h"

#include <gtest/gtest.h>

#include <stdexcept>
#include <vector>

namespace haptrial::psychometric {
namespace {

PestParameters wide() {
  PestParameters p;
  p.start = 0.0;
  p.low = -100.0;
  p.high = 100.0;
  p.target = 0.5;
  p.deviation = 0.5;  // every answer leads to a step
  p.first_step = 1.0;
  p.smallest_step = 0.3;
  p.largest_step = 8.0;
  return p;
}

std::vector<double> levels(Pest& pest, const std::vector<int>& answers) {
  std::vector<double> levels{pest.next()[0]};
  for (int answer : answers) {
    pest.report(answer, pest.next());
    if (pest.finished()) {
      break;
    }
    levels.push_back(pest.next()[0]);
  }
  return levels;
}

TEST(PestTest, TheThirdAndLaterStepsInADirectionDouble) {
  Pest pest(wide());
  EXPECT_EQ(levels(pest, {1, 1, 1, 1, 1, 1}),
            (std::vector<double>{0, -1, -2, -4, -8, -16, -24}));  // the largest step is 8
}

// A reversal halves. The step before the first reversal was not doubled, so the third step after it
// is; the step before the second one was, so the third step after that is not, but the fourth.
TEST(PestTest, TheThirdStepDependsOnTheStepBeforeTheReversal) {
  Pest pest(wide());
  EXPECT_EQ(levels(pest, {1, 1, 0, 0, 0, 1, 1, 1, 1}),
            (std::vector<double>{0, -1, -2, -1.5, -1, 0, -0.5, -1, -1.5, -2.5}));
}

TEST(PestTest, EndsWhenTheStepIsSmallest) {
  Pest pest(wide());
  EXPECT_TRUE(pest.estimates().empty());
  levels(pest, {1, 0, 1});  // steps 1, 0.5, 0.25
  ASSERT_TRUE(pest.finished());
  ASSERT_EQ(pest.estimates().size(), 1u);
  EXPECT_DOUBLE_EQ(pest.estimates()[0].value, -0.75);
  EXPECT_THROW(pest.next(), std::logic_error);
}

// With W = 1 and a target of 0.75: 3 T / 4 + 1 right answers, or 3 T / 4 - 1, end the level.
TEST(PestTest, ALevelIsKeptUntilTheCountLeavesItsBand) {
  auto p = wide();
  p.target = 0.75;
  p.deviation = 1.0;
  Pest all_right(p);
  EXPECT_EQ(levels(all_right, {1, 1, 1, 1}), (std::vector<double>{0, 0, 0, 0, -1}));
  Pest wrong(p);
  EXPECT_EQ(levels(wrong, {0, 0}), (std::vector<double>{0, 0, 1}));
  Pest even(p);
  EXPECT_EQ(levels(even, {1, 1, 0, 1, 1}), (std::vector<double>{0, 0, 0, 0, 0, 0}));
}

TEST(PestTest, BoundsNameTheParameter) {
  auto p = wide();
  p.smallest_step = 2.0;
  EXPECT_THROW(Pest{p}, std::invalid_argument);
  p = wide();
  p.target = 1.0;
  EXPECT_THROW(Pest{p}, std::invalid_argument);
  p = wide();
  p.start = 101.0;
  EXPECT_THROW(Pest{p}, std::invalid_argument);
}

}  // namespace
}  // namespace haptrial::psychometric
