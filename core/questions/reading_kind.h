#pragma once

#include "core/questions/question_kind.h"

namespace haptrial::questions {

/// A text that is read and gone on from: nothing is asked, and nothing is recorded.
class ReadingKind final : public QuestionKind {
 public:
  std::string word() const override { return "read"; }
  QuestionTraits traits() const noexcept override {
    return {.asks = false, .scored = false, .in_trials = false};
  }
  std::string key() const override { return ""; }
  void read(Table& table, Question& question) const override;
  std::vector<int> heard_keys(const Question&) const override { return {}; }
  KeyEffect press(const Question& question, const KeyPress& key,
                  AnswerDraft& draft) const noexcept override;
  bool is_complete(const Question&, const AnswerDraft&) const noexcept override { return true; }
  Answer answer(const Question&, const AnswerDraft&) const override { return {}; }
  AnswerDraft draft_of(const Question&, const Answer&) const override { return {}; }
  std::string parse(const Question&, const std::string&, AnswerDraft&) const override { return ""; }
  std::string written(const Question&, const AnswerDraft&) const override { return ""; }
  AnswerView view(const Question&, const AnswerDraft&) const override { return {}; }
  std::string hint(const Question&, const HintTexts& texts) const override { return texts.go_on; }
  void simulate(const Question&, std::optional<double>, RandomStream&,
                AnswerDraft&) const noexcept override {}
};

const QuestionKind& reading_kind();

}  // namespace haptrial::questions
