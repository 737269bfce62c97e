// Answers to a scale by the hand or by the mouse, which move its mark along a line.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "core/questions/question_kinds.h"
#include "protocols/psychophysics/presentation/pass_rows.h"
#include "protocols/psychophysics/presentation/trial_page.h"
#include "protocols/psychophysics/presentation/trial_pass.h"
#include "tests/protocols/psychophysics/definition/small_definition.h"
#include "tests/support/allocation_guard.h"

namespace haptrial::protocols::answers_by_mark_test {
namespace {

using testing::Contains;
using testing::HasSubstr;
using testing::IsEmpty;

constexpr double kDt = 1e-3;
constexpr int kStage = 10;  // ticks before the question
constexpr std::uint32_t kEnter = 1;

/// A scale from 0 to 100 in steps of 1 along 80 mm.
TrialQuestion scale_by(MarkedBy by) {
  TrialQuestion question;
  question.kind = &questions::scale_kind();
  question.high = 100.0;
  question.mark = {by, 0.08, 0b10};
  question.heard.push_back({kEnter, {KeyPress::kEnter}});
  return question;
}

class AnswersByMarkTest : public testing::Test {
 protected:
  void ask(MarkedBy by, double rightwards = 1.0, const std::vector<scene::Field>& fields = {}) {
    question_ = scale_by(by);
    Stage feel;
    feel.fields = fields.empty() ? 0b0 : 0b1;
    feel.until.time = kStage / 2 * kDt;
    Stage rest;
    rest.until.time = kStage / 2 * kDt;
    std::vector<scene::Scene> scenes;
    scenes.emplace_back(fields, 1.0 / kDt);
    TrialPass::Setup setup;
    setup.intervals.push_back(
        {std::move(scenes), StageMachine({feel, rest}, {}, fields.size()), {}, 0, -1});
    setup.intervals.back().sights.resize(2);
    setup.questions.push_back({&question_});
    setup.questions.back().rightwards = rightwards;
    pass_.emplace(std::move(setup));
    pass_->begin(5000);
    hold(kStage + 1);
  }
  void hold(int ticks) {
    for (int i = 0; i < ticks && pass_->state() == PassState::kRunning; ++i) {
      out_ = pass_->tick(reading_, kDt);
      view_ = *out_.shown.as<TrialView>();
    }
  }
  void move_hand(double x) {
    reading_.tool.position.x() = x;
    hold(1);
  }
  void press_button(std::uint32_t bits) {
    reading_.buttons = bits;
    hold(1);
    reading_.buttons = 0;
    hold(1);
  }
  record::ResponseRow row() const { return response_rows(*pass_, {question_}, {-1}).at(0); }

  TrialQuestion question_;
  std::optional<TrialPass> pass_;
  device::DeviceReading reading_;
  PassOutput out_;
  TrialView view_;
};

TEST_F(AnswersByMarkTest, TheMarkIsWhereTheHandIsOnceItHasMoved) {
  ask(MarkedBy::kHand);
  EXPECT_EQ(view_.chosen, -1) << "no place is suggested";
  press_button(0b10);
  EXPECT_EQ(pass_->state(), PassState::kRunning);
  EXPECT_TRUE(view_.refused);
  move_hand(0.001);
  EXPECT_EQ(view_.chosen, -1) << "a tremor is no answer";
  move_hand(0.02);
  EXPECT_FALSE(view_.refused);
  EXPECT_EQ(view_.chosen, 75) << "a quarter of the line beyond its middle";
  move_hand(-0.3);
  EXPECT_EQ(view_.chosen, 0) << "the line ends";
  move_hand(-0.02);
  press_button(0b01);
  EXPECT_EQ(pass_->state(), PassState::kRunning) << "another button";
  press_button(0b10);
  ASSERT_EQ(pass_->state(), PassState::kCompleted);
  EXPECT_EQ(row().value, 25.0);
  EXPECT_EQ(row().source, record::ResponseSource::kButton);
  EXPECT_EQ(row().code, 1);
  EXPECT_NEAR(row().reaction_time, 1e-3 * static_cast<double>(row().sequence - 5000 - kStage + 1),
              1e-9);
  EXPECT_TRUE(out_.force.isZero(0.0)) << "nothing is felt while answering";
}

TEST_F(AnswersByMarkTest, EnterGivesTheAnswerToo) {
  ask(MarkedBy::kHand);
  move_hand(0.03);
  reading_.keys = kEnter;
  hold(1);
  ASSERT_EQ(pass_->state(), PassState::kCompleted);
  EXPECT_EQ(row().source, record::ResponseSource::kKey);
  EXPECT_NEAR(row().value, 87.5, 0.51);
}

TEST_F(AnswersByMarkTest, AMirroredParticipantSeesTheLowEndOnTheLeft) {
  ask(MarkedBy::kHand, -1.0);
  move_hand(-0.02);
  EXPECT_EQ(view_.chosen, 75);
}

TEST_F(AnswersByMarkTest, AClickOnTheLineGivesTheAnswer) {
  ask(MarkedBy::kMouse);
  move_hand(0.03);
  EXPECT_EQ(view_.chosen, -1) << "the hand answers nothing";
  reading_.pointer.buttons = 1;
  hold(1);
  EXPECT_EQ(pass_->state(), PassState::kRunning) << "no pointer was over the window";
  reading_.pointer = {0.01, 0};
  hold(1);
  reading_.pointer.buttons = 0b10;
  hold(1);
  EXPECT_EQ(pass_->state(), PassState::kRunning) << "the right button";
  reading_.pointer = {0.012, 1};
  hold(1);
  ASSERT_EQ(pass_->state(), PassState::kCompleted);
  EXPECT_EQ(row().value, 65.0);
  EXPECT_EQ(row().source, record::ResponseSource::kPointer);
}

TEST_F(AnswersByMarkTest, DoesNotAllocate) {
  ask(MarkedBy::kHand);
  const test::AllocationGuard guard;
  for (int i = 0; i < 50; ++i) {
    move_hand(0.0005 * i);
  }
  EXPECT_EQ(guard.count(), 0U);
}

std::string asking(const std::string& keys, const std::string& more = "") {
  std::string text = small_trials(kSmallStaircase, more);
  const std::size_t from = text.find("[response]");
  text.replace(from, text.find("\n[", from + 1) - from,
               "[[responses]]\nquestion = \"Which?\"\n"
               "choices = [{ value = \"first\" }, { value = \"second\" }]\n"
               "correct = \"$interval.comparison\"\n"
               "[[responses]]\nname = \"much\"\nquestion = \"How much?\"\n" +
                   keys);
  return text;
}

TEST(MarkMeansTest, AScaleByHandNeedsNoSteps) {
  TrialsDefinition d;
  read_small(asking("scale = [0, 100]\nby = \"hand\"\n"), d);
  EXPECT_EQ(d.questions[1].mark.by, MarkedBy::kHand);
  EXPECT_EQ(d.questions[1].heard.size(), 1U) << "Enter alone";
  EXPECT_FALSE(d.hears_pointer());
  TrialView view;
  view.question = 2;
  const render::TextPage page = text_of(d, view).page;
  ASSERT_TRUE(page.answer.scale);
  EXPECT_NEAR(page.answer.scale->length, d.questions[1].mark.length / d.view.width, 1e-12)
      << "the line is drawn where the hand moves along it";
  EXPECT_EQ(page.hint, d.texts.place_mark);
  read_small(asking("scale = [0, 100]\nby = \"mouse\"\n"), d);
  EXPECT_TRUE(d.hears_pointer());
}

TEST(MarkMeansTest, MistakesAreNamed) {
  const auto problems = [](const std::string& keys, const std::string& more = "") {
    return problems_of_trials(asking(keys, more));
  };
  EXPECT_THAT(problems("scale = [0, 10]\nby = \"hand\"\n"), IsEmpty());
  EXPECT_THAT(problems("scale = [0, 10]\nby = \"head\"\n"),
              Contains(HasSubstr("keys, hand, mouse")));
  EXPECT_THAT(problems("scale = [0, 10]\nstep = 1\nlength = 0.1\n"),
              Contains(HasSubstr("length stands alone; add by")));
  EXPECT_THAT(problems("scale = [0, 10]\nby = \"mouse\"\nbuttons = [1]\n"),
              Contains(HasSubstr("buttons stands alone; add by = \"hand\"")));
  EXPECT_THAT(problems("scale = [0, 10]\nby = \"hand\"\nlength = 0.5\n"),
              Contains(HasSubstr("0.8 of display.extent")));
  EXPECT_THAT(
      problems("scale = [0, 10]\nby = \"hand\"\nlength = 0.3\n", "[display]\nextent = 0.5\n"),
      Contains(HasSubstr("envelope.workspace_radius")));
  EXPECT_THAT(problems("scale = [0, 10]\nby = \"mouse\"\n", "[display]\nstereo = true\n"),
              Contains(HasSubstr("no pointer is on the line")));
  EXPECT_THAT(problems("number = [0, 10]\nby = \"hand\"\n"), Contains(HasSubstr("by")))
      << "numbers have no mark";
}

/// A constant force that was left in the first stage and would fade for a minute.
TEST_F(AnswersByMarkTest, NoFieldActsForLongWhileTheHandMarks) {
  scene::Field push;
  push.name = "push";
  push.kind = scene::ConstantParameters{{1.0, 0.0, 0.0}};
  push.fade_in = 0.0;
  push.fade_out = 60.0;
  const auto force_after = [&](MarkedBy by, int ticks) {
    ask(by, 1.0, {push});
    hold(ticks);
    return out_.force.norm();
  };
  EXPECT_GT(force_after(MarkedBy::kHand, 0), 0.9) << "it is on when the question begins";
  EXPECT_GT(force_after(MarkedBy::kHand, 500), 0.1) << "it takes no step";
  EXPECT_EQ(force_after(MarkedBy::kHand, 1001), 0.0);
  EXPECT_GT(force_after(MarkedBy::kMouse, 1001), 0.9) << "this hand gives no answer";
}

}  // namespace
}  // namespace haptrial::protocols::answers_by_mark_test
