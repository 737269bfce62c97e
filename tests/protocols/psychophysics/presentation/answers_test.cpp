// Answers by place and pedal, and those that come too early or too late: what one pass makes of
// every tick.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "protocols/psychophysics/presentation/trial_pass.h"
#include "tests/support/allocation_guard.h"

namespace haptrial::protocols::answers_test {
namespace {

using record::ResponseSource;

constexpr double kDt = 1e-3;
constexpr std::uint64_t kFirst = 5000;  // sequence number
constexpr int kStage = 10;              // ticks before the question

/// A question by hand: left at x = -30 mm, right at x = 30 mm, both of radius 10 mm; not sure by
/// the pedal.
TrialQuestion by_hand() {
  TrialQuestion q;
  q.name = "side";
  q.choices = {{"left", "left"}, {"right", "right"}, {"not sure", "not sure"}};
  q.means = {{"", 0, 0, "left_box"}, {"", 0, 0, "right_box"}, {"", 0, 0, "", 0.6}};
  q.touch_for = 0.05;
  return q;
}

/// One stage of ten ticks, then the questions.
TrialPass pass_of(const std::vector<const TrialQuestion*>& questions, int right = -1) {
  Stage feel;
  feel.until.time = kStage * kDt;
  std::vector<scene::Scene> scenes;
  scenes.emplace_back(std::vector<scene::Field>{}, 1.0 / kDt);
  TrialPass::Setup setup;
  setup.feedback_time = 0.1;
  setup.intervals.push_back({std::move(scenes), StageMachine({feel}, {}, 0), {}, 0, -1});
  setup.intervals.back().sights.resize(1);
  for (const TrialQuestion* question : questions) {
    PresentedQuestion asked{question};
    asked.right = right;
    asked.feedback = right >= 0;
    for (std::size_t i = 0; i < 2 && question->touched(); ++i) {
      const double x = i == 0 ? -0.03 : 0.03;
      asked.places.push_back(
          {scene::PlacedShape(scene::Sphere{{x, 0.0, 0.0}, 0.01}), 0, i, static_cast<int>(i)});
    }
    setup.questions.push_back(std::move(asked));
  }
  return TrialPass(std::move(setup));
}

class AnswersTest : public testing::Test {
 protected:
  /// A hand that stays at x, tick by tick, until the pass is over or `ticks` have passed.
  void stay(TrialPass& pass, int ticks, double x, double pedal = 0.0) {
    for (int i = 0; i < ticks && pass.state() == PassState::kRunning; ++i) {
      device::DeviceReading reading;
      reading.tool.position.x() = x;
      reading.pedal = pedal;
      view_ = *pass.tick(reading, kDt).shown.as<TrialView>();
      ++ticks_;
    }
  }
  TrialView view_;
  int ticks_{0};
};

TEST_F(AnswersTest, APlaceAnswersWhenTheTipStaysInItAndIsTimedWhenItComesIn) {
  const TrialQuestion question = by_hand();
  TrialPass pass = pass_of({&question});
  pass.begin(kFirst);
  stay(pass, kStage + 300, 0.0);
  stay(pass, 49, -0.03);  // one tick too short
  stay(pass, 40, 0.0);
  EXPECT_EQ(pass.state(), PassState::kRunning);
  stay(pass, 1000, 0.03);
  ASSERT_EQ(pass.state(), PassState::kCompleted);
  const Answer& answer = pass.answers().front();
  EXPECT_EQ(answer.choice, 1);
  EXPECT_EQ(answer.source, ResponseSource::kPlace);
  EXPECT_EQ(answer.code, 1);
  // The answer came in on tick 10 + 300 + 49 + 40, counted from 0, 390 ticks of the question.
  EXPECT_EQ(answer.sequence, kFirst + kStage + 389);
  EXPECT_DOUBLE_EQ(answer.reaction_time, 390 * kDt);
  EXPECT_EQ(ticks_, kStage + 389 + 51);  // and had stayed for 50 ms
}

TEST_F(AnswersTest, AHandThatIsThereAlreadyHasNotAnswered) {
  const TrialQuestion question = by_hand();
  TrialPass pass = pass_of({&question});
  pass.begin(kFirst);
  stay(pass, kStage + 500, -0.03);
  EXPECT_EQ(pass.state(), PassState::kRunning);
  stay(pass, 1, 0.0);
  stay(pass, 100, -0.03);
  ASSERT_EQ(pass.state(), PassState::kCompleted);
  EXPECT_EQ(pass.answers().front().choice, 0);
  EXPECT_DOUBLE_EQ(pass.answers().front().reaction_time, 502 * kDt);
}

TEST_F(AnswersTest, ThePedalAnswersWhenItGoesDownDuringTheQuestion) {
  const TrialQuestion question = by_hand();
  TrialPass pass = pass_of({&question});
  pass.begin(kFirst);
  stay(pass, kStage + 200, 0.0, 0.9);  // down since the trial began
  stay(pass, 10, 0.0, 0.4);            // not up by half of its depth
  stay(pass, 10, 0.0, 0.9);
  EXPECT_EQ(pass.state(), PassState::kRunning);
  stay(pass, 20, 0.0, 0.3);
  stay(pass, 30, 0.0, 0.59);
  EXPECT_EQ(pass.state(), PassState::kRunning);
  stay(pass, 30, 0.0, 0.6);
  ASSERT_EQ(pass.state(), PassState::kCompleted);
  const Answer& answer = pass.answers().front();
  EXPECT_EQ(answer.choice, 2);
  EXPECT_EQ(answer.source, ResponseSource::kPedal);
  EXPECT_DOUBLE_EQ(answer.reaction_time, 271 * kDt);
}

TrialQuestion limited(bool again) {
  TrialQuestion q;
  q.name = "answer";
  q.choices = {{"yes", "yes"}, {"no", "no"}};
  q.means = {{"", 0, 0, "", 0.5}, {"", 0, 2}};
  q.too_fast = 0.15;
  q.too_slow = 0.4;
  q.again = again;
  return q;
}

struct Case {
  int ticks;  // of the question on which the answer comes
  Pace pace;
};

class PaceTest : public AnswersTest, public testing::WithParamInterface<Case> {};

TEST_P(PaceTest, AnAnswerOutOfTimeIsToldAndKept) {
  const TrialQuestion question = limited(false);
  TrialPass pass = pass_of({&question, &question});
  pass.begin(kFirst);
  stay(pass, kStage + GetParam().ticks - 1, 0.0);
  stay(pass, 1, 0.0, 1.0);
  EXPECT_EQ(pass.answers().front().pace, GetParam().pace);
  EXPECT_DOUBLE_EQ(pass.answers().front().reaction_time, GetParam().ticks * kDt);
  stay(pass, 1, 0.0);
  EXPECT_EQ(view_.pace, GetParam().pace);
  EXPECT_EQ(view_.question, GetParam().pace == Pace::kInTime ? 2 : 1);
  stay(pass, 110, 0.0);
  EXPECT_EQ(view_.question, 2) << "the next question follows";
  EXPECT_EQ(view_.pace, Pace::kInTime);
}

TEST_P(PaceTest, OneThatComesAgainEndsTheTrial) {
  const TrialQuestion question = limited(true);
  TrialPass pass = pass_of({&question, &question}, 0);
  pass.begin(kFirst);
  stay(pass, kStage + GetParam().ticks - 1, 0.0);
  stay(pass, 1, 0.0, 1.0);
  stay(pass, 1, 0.0);
  const bool late = GetParam().pace != Pace::kInTime;
  EXPECT_EQ(view_.verdict, late ? Verdict::kNone : Verdict::kRight);
  stay(pass, 110, 0.0);
  EXPECT_EQ(pass.state(), late ? PassState::kCompleted : PassState::kRunning);
  EXPECT_EQ(pass.answers().back().given, false);
}

INSTANTIATE_TEST_SUITE_P(Times, PaceTest,
                         testing::Values(Case{149, Pace::kTooFast}, Case{150, Pace::kInTime},
                                         Case{400, Pace::kInTime}, Case{401, Pace::kTooSlow}));

TEST_F(AnswersTest, AReactionTimeIsNotKnownIfTheLoopStoodStillInIt) {
  const TrialQuestion question = limited(false);
  const auto answered = [&](int before, int after) {
    TrialPass pass = pass_of({&question});
    pass.begin(kFirst);
    stay(pass, before, 0.0);
    pass.note_suspension();
    stay(pass, after, 0.0);
    stay(pass, 1, 0.0, 1.0);
    return pass.answers().front();
  };
  EXPECT_DOUBLE_EQ(answered(kStage - 1, 201).reaction_time, 201 * kDt) << "before the question";
  const Answer interrupted = answered(kStage + 50, 20);
  EXPECT_TRUE(interrupted.given);
  EXPECT_TRUE(std::isnan(interrupted.reaction_time));
  EXPECT_EQ(interrupted.pace, Pace::kInTime) << "nobody knows that it was too fast";
}

TEST_F(AnswersTest, TheTickAllocatesNothing) {
  const TrialQuestion question = by_hand(), other = limited(false);
  TrialPass pass = pass_of({&question, &other});
  pass.begin(kFirst);
  const test::AllocationGuard guard;
  stay(pass, 100, 0.0);
  stay(pass, 100, 0.03);
  stay(pass, 100, 0.03, 1.0);
  EXPECT_EQ(guard.count(), 0u);
}

}  // namespace
}  // namespace haptrial::protocols::answers_test
