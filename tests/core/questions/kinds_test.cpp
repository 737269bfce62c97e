// Every kind of question keeps the same promises, whichever it is.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <optional>
#include <stdexcept>
#include <string>

#include "core/base/definition/table.h"
#include "core/base/random.h"
#include "core/questions/question_kind.h"
#include "core/questions/question_kinds.h"
#include "tests/support/allocation_guard.h"

namespace haptrial::questions {
namespace {

using testing::HasSubstr;

Question question_of(const QuestionKind& kind) {
  Question question;
  question.name = "x";
  question.kind = &kind;
  question.choices = {{"a", "A", 1.0}, {"b", "B", 2.0}, {"c", "C", 3.0}};
  question.low = -1.0;
  question.high = 1.0;
  question.step = 0.25;
  return question;
}

bool is_same(const Answer& a, const Answer& b) {
  return a.text == b.text && (a.value == b.value || (std::isnan(a.value) && std::isnan(b.value)));
}

class KindsTest : public testing::TestWithParam<const QuestionKind*> {
 protected:
  const QuestionKind& kind_{*GetParam()};
  Question question_{question_of(kind_)};
};

TEST_P(KindsTest, AVirtualAnswerIsAllowedAndSurvivesEveryForm) {
  RandomStream random(7, "kinds");
  for (const std::optional<double> felt :
       {std::optional<double>(), std::optional(0.4), std::optional(1e300), std::optional(-7.0)}) {
    for (int i = 0; i < 20; ++i) {
      AnswerDraft draft;
      kind_.simulate(question_, felt, random, draft);
      ASSERT_TRUE(kind_.is_complete(question_, draft));
      const Answer answer = kind_.answer(question_, draft);
      const AnswerDraft again = kind_.draft_of(question_, answer);
      EXPECT_TRUE(is_same(kind_.answer(question_, again), answer));
      AnswerDraft parsed;
      if (!kind_.traits().consents) {  // an experimenter consents with a reason alone
        EXPECT_EQ(kind_.parse(question_, kind_.written(question_, draft), parsed), "");
        EXPECT_TRUE(is_same(kind_.answer(question_, parsed), answer));
      }
    }
  }
}

TEST_P(KindsTest, KeysNeitherAllocateNorAllowWhatWordsMayNot) {
  RandomStream random(7, "keys");
  AnswerDraft draft;
  AnswerDraft simulated;
  bool complete = true;
  {
    const test::AllocationGuard guard;
    for (int i = 0; i < 3000; ++i) {
      const int code = static_cast<int>(random.below(10));
      const KeyPress key = random.below(2) == 0 ? KeyPress{KeyPress::kBackspace + code}
                           : random.below(2) == 0
                               ? KeyPress{'0' + code}
                               : KeyPress{KeyPress::kOther, static_cast<char32_t>('+' + code)};
      kind_.press(question_, key, draft);
      complete = kind_.is_complete(question_, draft) && complete;
      kind_.simulate(question_, 0.3, random, simulated);
    }
    EXPECT_EQ(guard.count(), 0u);
  }
  if (kind_.is_complete(question_, draft) && !kind_.traits().consents) {
    AnswerDraft parsed;
    EXPECT_EQ(kind_.parse(question_, kind_.written(question_, draft), parsed), "");
  }
}

INSTANTIATE_TEST_SUITE_P(AllKinds, KindsTest, testing::ValuesIn(kinds_of_question()),
                         [](const auto& each) { return each.param->word(); });

TEST(QuestionKindsTest, ATypedNumberIsExactly) {
  const Question question = question_of(number_kind());
  RandomStream random(3, "exact");
  for (int i = 0; i < 1000; ++i) {
    const double value = random.uniform(-1.0, 1.0);
    AnswerDraft draft;
    number_kind().simulate(question, value, random, draft);
    EXPECT_EQ(number_kind().answer(question, draft).value, value);
  }
}

TEST(QuestionKindsTest, ATableStatesOneKind) {
  const auto stated = [](const std::string& text) {
    Table table = Table::parse(text, "a.toml");
    const QuestionKind* kind = stated_kind(table, kinds_of_question());
    return kind == nullptr ? "none" : kind->word();
  };
  EXPECT_EQ(stated("scale = [0, 1]\n"), "scale");
  EXPECT_EQ(stated("words = true\n"), "words");
  EXPECT_EQ(stated("words = false\nnumber = [0, 1]\n"), "number");
  EXPECT_EQ(stated("scale = [0, 1]\nnumber = [0, 1]\n"), "none");
  EXPECT_EQ(stated("question = \"?\"\n"), "none");
}

TEST(QuestionKindsTest, AWordIsTakenOnce) {
  EXPECT_THROW(add_kind_of_question(scale_kind()), std::invalid_argument);
}

TEST(QuestionKindsTest, TypedWordsStayWithinTheirBytes) {
  Question question = question_of(words_kind());
  question.most_bytes = 3;
  AnswerDraft draft;
  for (const char32_t c : std::u32string(U"aéb")) {
    words_kind().press(question, {KeyPress::kOther, c}, draft);
  }
  EXPECT_EQ(draft.typed.view(), "aé") << "the b has no room";
  EXPECT_THAT(words_kind().parse(question, "four", draft),
              HasSubstr("4 bytes; allowed: at most 3"));
}

}  // namespace
}  // namespace haptrial::questions
