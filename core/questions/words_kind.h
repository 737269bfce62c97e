#pragma once

#include "core/questions/question_kind.h"

namespace haptrial::questions {

/// Typed words of any script. An answer may be empty.
class WordsKind final : public QuestionKind {
 public:
  std::string word() const override { return "words"; }
  QuestionTraits traits() const noexcept override {
    return {.scored = false, .types = true, .any_character = true};
  }
  std::string key() const override { return "words"; }
  bool is_stated(Table& table) const override;
  void read(Table&, Question&) const override {}
  std::vector<int> heard_keys(const Question& question) const override;
  KeyEffect press(const Question& question, const KeyPress& key,
                  AnswerDraft& draft) const noexcept override;
  bool is_complete(const Question& question, const AnswerDraft& draft) const noexcept override;
  Answer answer(const Question& question, const AnswerDraft& draft) const override;
  AnswerDraft draft_of(const Question& question, const Answer& answer) const override;
  std::string parse(const Question& question, const std::string& words,
                    AnswerDraft& draft) const override;
  std::string written(const Question& question, const AnswerDraft& draft) const override;
  AnswerView view(const Question& question, const AnswerDraft& draft) const override;
  std::string hint(const Question& question, const HintTexts& texts) const override;
  void simulate(const Question& question, std::optional<double> felt, RandomStream& random,
                AnswerDraft& draft) const noexcept override;
};

const QuestionKind& words_kind();

}  // namespace haptrial::questions
