// Answers by the keys of the window to questions without choices: a mark, a number, words.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "core/questions/question_kinds.h"
#include "protocols/psychophysics/presentation/pass_rows.h"
#include "protocols/psychophysics/presentation/trial_pass.h"
#include "tests/support/allocation_guard.h"

namespace haptrial::protocols::answers_by_keys_test {
namespace {

constexpr double kDt = 1e-3;
constexpr int kStage = 10;  // ticks before the question

TrialQuestion question_of(const questions::QuestionKind& kind) {
  TrialQuestion question;
  question.kind = &kind;
  question.low = 0.0;
  question.high = 100.0;
  question.step = 5.0;
  question.most_bytes = record::kAnswerBytes;
  std::uint32_t bit = 1;
  for (const int key : kind.heard_keys(question)) {
    question.heard.push_back({bit, key});
    bit <<= 1;
  }
  question.heard.push_back({bit, KeyPress::kEnter});
  return question;
}

class AnswersByKeysTest : public testing::Test {
 protected:
  void ask(const questions::QuestionKind& kind) {
    question_ = question_of(kind);
    question_.low = low_;
    Stage feel;
    feel.until.time = kStage * kDt;
    std::vector<scene::Scene> scenes;
    scenes.emplace_back(std::vector<scene::Field>{}, 1.0 / kDt);
    TrialPass::Setup setup;
    setup.intervals.push_back({std::move(scenes), StageMachine({feel}, {}, 0), {}, 0, -1});
    setup.intervals.back().sights.resize(1);
    setup.questions.push_back({&question_});
    pass_.emplace(std::move(setup));
    pass_->begin(5000);
    hold(0, kStage + 1);
  }
  void hold(std::uint32_t keys, int ticks, char32_t typed = 0) {
    for (int i = 0; i < ticks && pass_->state() == PassState::kRunning; ++i) {
      device::DeviceReading reading;
      reading.keys = keys;
      reading.typed = typed;
      view_ = *pass_->tick(reading, kDt).shown.as<TrialView>();
    }
  }
  std::uint32_t bit_of(int key) const {
    for (const HeardBit& each : question_.heard) {
      if (each.key == key) {
        return each.bit;
      }
    }
    ADD_FAILURE() << "the question does not hear this key";
    return 0;
  }
  void press(int key, int ticks = 30) {
    hold(bit_of(key), ticks);
    hold(0, 30);
  }
  /// A digit comes as a key that the question hears and as a character, which a held key types
  /// once.
  void type(const std::u32string& text) {
    for (const char32_t c : text) {
      const std::uint32_t key = c >= U'0' && c <= U'9' ? bit_of(static_cast<int>(c)) : 0;
      hold(key, 1, c);
      hold(key, 700);
      hold(0, 30);
    }
  }
  void enter() { press(KeyPress::kEnter); }
  record::ResponseRow row() const { return response_rows(*pass_, {question_}, {-1}).at(0); }

  double low_{0.0};
  TrialQuestion question_;
  std::optional<TrialPass> pass_;
  TrialView view_;
};

TEST_F(AnswersByKeysTest, AMarkHasNoPlaceBeforeItIsMoved) {
  ask(questions::scale_kind());
  enter();
  EXPECT_EQ(pass_->state(), PassState::kRunning);
  EXPECT_TRUE(view_.refused);
  press(KeyPress::kRight);
  EXPECT_FALSE(view_.refused);
  EXPECT_EQ(view_.chosen, 11) << "one step from the middle of 20";
  press(KeyPress::kLeft);
  press(KeyPress::kDown);
  enter();
  ASSERT_EQ(pass_->state(), PassState::kCompleted);
  EXPECT_EQ(row().value, 45.0);
  EXPECT_EQ(row().text, "");
  EXPECT_EQ(row().source, record::ResponseSource::kKey);
  EXPECT_GT(row().reaction_time, 0.0);
}

// The first repetition comes after 0.4 s, and one every 50 ms after it: 1 + 5 steps in 0.62 s.
TEST_F(AnswersByKeysTest, AKeyThatIsHeldMovesTheMarkOn) {
  ask(questions::scale_kind());
  press(KeyPress::kRight, 620);
  EXPECT_EQ(view_.chosen, 10 + 6);
  press(KeyPress::kRight, 2000);
  EXPECT_EQ(view_.chosen, 20);
  press('8');
  press('5');
  EXPECT_EQ(view_.chosen, 17) << "digits say a number";
  hold(bit_of(KeyPress::kEnter), 1);
  ASSERT_EQ(pass_->state(), PassState::kCompleted);
  EXPECT_EQ(row().value, 85.0);
}

TEST_F(AnswersByKeysTest, ANumberBeyondItsBoundsIsTypedAgain) {
  ask(questions::number_kind());
  type(U"101");
  EXPECT_STREQ(view_.typed.data(), "101");
  enter();
  EXPECT_TRUE(view_.refused);
  EXPECT_STREQ(view_.typed.data(), "");
  type(U"42.53");
  press(KeyPress::kBackspace);
  enter();
  ASSERT_EQ(pass_->state(), PassState::kCompleted);
  EXPECT_EQ(row().value, 42.5);
}

TEST_F(AnswersByKeysTest, ANumberIsTheCharactersThatAreTyped) {
  low_ = -10.0;
  for (const auto& [typed, value] : {std::pair{U"2,5", 2.5}, {U"-5", -5.0}, {U"37", 37.0}}) {
    ask(questions::number_kind());
    type(typed);
    enter();
    ASSERT_EQ(pass_->state(), PassState::kCompleted);
    EXPECT_EQ(row().value, value);
  }
}

TEST_F(AnswersByKeysTest, WordsOfAnyScriptAreTyped) {
  ask(questions::words_kind());
  for (const char32_t c : std::u32string(U"räu粗x")) {
    hold(0, 1, c);
  }
  press(KeyPress::kBackspace);
  EXPECT_STREQ(view_.typed.data(), "räu粗");
  enter();
  ASSERT_EQ(pass_->state(), PassState::kCompleted);
  EXPECT_EQ(row().text, "räu粗");
  EXPECT_TRUE(std::isnan(row().value));
}

TEST_F(AnswersByKeysTest, WordsEndWhereTheirRowDoes) {
  ask(questions::words_kind());
  hold(0, 200, U'é');
  enter();
  EXPECT_EQ(row().text.size(), record::kAnswerBytes);
}

TEST_F(AnswersByKeysTest, TheTickAllocatesNothing) {
  for (const questions::QuestionKind* kind : questions::kinds_of_question()) {
    if (kind->traits().in_trials && kind != &questions::choice_kind()) {
      ask(*kind);
      const test::AllocationGuard guard;
      for (const HeardBit& each : question_.heard) {
        hold(each.bit, 500, U'4');
        hold(0, 1);
      }
      EXPECT_EQ(guard.count(), 0u) << kind->word();
    }
  }
}

}  // namespace
}  // namespace haptrial::protocols::answers_by_keys_test
