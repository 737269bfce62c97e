#pragma once

#include "core/questions/question_kind.h"

namespace haptrial::questions {

/// One of several answers, by its number or by the arrow keys.
class ChoiceKind : public QuestionKind {
 public:
  std::string word() const override { return "choice"; }
  QuestionTraits traits() const noexcept override { return {}; }
  std::string key() const override { return "choices"; }
  void read(Table& table, Question& question) const override;
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

}  // namespace haptrial::questions
