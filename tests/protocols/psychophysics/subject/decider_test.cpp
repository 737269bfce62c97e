#include "protocols/psychophysics/subject/decider.h"

#include <gtest/gtest.h>

#include <array>

#include "core/questions/number_kind.h"

namespace haptrial::protocols {
namespace {

constexpr std::array kTwoIntervals{4.0, 16.0};  // percepts

TEST(DeciderTest, TheLastIntervalIsJudgedWhateverCameBefore) {
  ObserverPlan plan;
  subject::JudgementParameters judgement;
  judgement.exponent = 0.5;
  judgement.criterion = 8.0;
  TrialQuestion number;
  number.kind = &questions::number_kind();
  number.high = 1000.0;
  plan.decides = Decides::kMagnitude;
  const auto said = Decider(plan, judgement, 1).decide(number, true, kTwoIntervals);
  EXPECT_NEAR(given_answer(number, said.choice, said.draft).value, 4.0, 1e-12);
  TrialQuestion choice;
  choice.choices.resize(2);
  plan.decides = Decides::kYes;
  plan.yes = 1;
  EXPECT_EQ(Decider(plan, judgement, 1).decide(choice, true, kTwoIntervals).choice, 1);
  plan.decides = Decides::kNearest;
  plan.prototypes = {4.0, 16.0};
  EXPECT_EQ(Decider(plan, judgement, 1).decide(choice, true, kTwoIntervals).choice, 1);
}

}  // namespace
}  // namespace haptrial::protocols
