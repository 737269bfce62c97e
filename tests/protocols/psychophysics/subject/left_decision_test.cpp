// A decision that a virtual participant leaves to the session's thread: no tick waits for it or
// allocates, and an answer that nobody waits for any more is dropped.
#include <gtest/gtest.h>

#include <Eigen/Core>
#include <array>
#include <memory>
#include <vector>

#include "core/base/definition/table.h"
#include "core/questions/question_kinds.h"
#include "protocols/psychophysics/presentation/trial_view.h"
#include "protocols/psychophysics/subject/decider.h"
#include "protocols/psychophysics/subject/trials_rig.h"
#include "protocols/psychophysics/studied_definition.h"
#include "protocols/psychophysics/trials_protocol.h"
#include "tests/support/allocation_guard.h"
#include "tests/support/felt_or_not.h"

namespace haptrial::protocols::left_decision_test {
namespace {

constexpr double kTick = 0.001;  // [s]

class LeftDecisionTest : public testing::Test {
 protected:
  LeftDecisionTest() {
    Table root = Table::parse(
        test::felt_or_not("choices = [{ value = \"no\" }, { value = \"yes\" }]"), "study.toml");
    definition_ = trials_protocol().read(root, "study.toml", nullptr);
    const auto& d = dynamic_cast<const StudiedDefinition&>(*definition_);
    rig_ = std::make_unique<TrialsRig>(
        TrialsRig::Briefing{&d, &d.observer, &d.questions, d.stages, &d.hands, &said_,
                            [this](const LeftDecision::DecisionRequest& asked) {
                              asked_.push_back(asked);
                              return answer_;
                            }},
        1, 2);
  }
  void show(const TrialView& view, int ticks) {
    const stimulus::Shown shown(view);
    for (int i = 0; i < ticks; ++i) {
      rig_->subject()->observe(shown, Eigen::Vector3d(Eigen::Vector3d::Zero()), kTick);
    }
  }
  void show_nothing() {
    rig_->subject()->observe(stimulus::Shown(), Eigen::Vector3d(Eigen::Vector3d::Zero()), kTick);
  }
  static TrialView interval(int trial) {
    TrialView view;
    view.trial = trial;
    view.interval = 1;
    return view;
  }
  static TrialView question(int trial) {
    TrialView view;
    view.trial = trial;
    view.question = 1;
    return view;
  }

  std::unique_ptr<Definition> definition_;
  SimulatedAnswer said_;
  LeftDecision::Answer answer_{1, {}, 0.010};
  std::vector<LeftDecision::DecisionRequest> asked_;
  std::unique_ptr<TrialsRig> rig_;
};

TEST_F(LeftDecisionTest, TicksGoOnUntilTheAnswerIsThereAndAllocateNothing) {
  const test::AllocationGuard guard;
  show(interval(1), 50);
  EXPECT_FALSE(rig_->left()->waits());
  show(question(1), 5000);
  EXPECT_EQ(guard.count(), 0u);
  EXPECT_TRUE(rig_->left()->waits());
  EXPECT_FALSE(said_.given) << "whatever its own reaction time";
  rig_->attend();
  EXPECT_FALSE(rig_->left()->waits());
  show(question(1), 1);
  EXPECT_TRUE(said_.given);
  EXPECT_EQ(said_.choice, 1);
  ASSERT_EQ(asked_.size(), 1u);
  EXPECT_EQ(asked_[0].question, 0u);
  EXPECT_EQ(asked_[0].intervals, 1u);
  EXPECT_GE(asked_[0].proposed.choice, 0);
  EXPECT_GT(asked_[0].proposed.reaction, 0.0);
}

TEST_F(LeftDecisionTest, TheAnswerComesWhenItsReactionTimeIsOver) {
  show(interval(1), 50);
  show(question(1), 1);
  rig_->attend();
  show(question(1), 7);
  EXPECT_FALSE(said_.given);
  show(question(1), 3);
  EXPECT_TRUE(said_.given) << "10 ms after the question";
}

TEST_F(LeftDecisionTest, ATrialThatWasBrokenOffIsAskedAboutAgain) {
  show(interval(1), 50);
  show(question(1), 1);
  show_nothing();
  show(interval(1), 50);
  EXPECT_FALSE(rig_->left()->waits()) << "what was asked before counts no more";
  rig_->attend();
  EXPECT_TRUE(asked_.empty());
  show(question(1), 1);
  rig_->attend();
  show(question(1), 20);
  EXPECT_TRUE(said_.given);
  EXPECT_EQ(asked_.size(), 1u);
}

TEST(LeftDecisionMailboxTest, AnAnswerThatNobodyWaitsForIsDropped) {
  LeftDecision left;
  left.ask({});
  left.forget();
  left.answer({1, {}, 0.0});
  EXPECT_EQ(left.answer(), nullptr);
  left.ask({});
  left.answer({2, {}, 0.0});
  ASSERT_NE(left.answer(), nullptr);
  EXPECT_EQ(left.answer()->choice, 2);
}

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
}  // namespace haptrial::protocols::left_decision_test
