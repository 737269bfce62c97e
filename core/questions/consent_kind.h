#pragma once

#include "core/questions/choice_kind.h"

namespace haptrial::questions {

/// Consent to take part, which is accepted or declined: choices 0 and 1. An experimenter agrees in
/// the participant's place only with a reason, "1: paper form signed".
class ConsentKind final : public ChoiceKind {
 public:
  std::string word() const override { return "consent"; }
  QuestionTraits traits() const noexcept override {
    return {.consents = true, .scored = false, .in_trials = false};
  }
  std::string key() const override { return ""; }
  void read(Table& table, Question& question) const override;
  Answer answer(const Question& question, const AnswerDraft& draft) const override;
  std::string parse(const Question& question, const std::string& words,
                    AnswerDraft& draft) const override;
  void simulate(const Question& question, std::optional<double> felt, RandomStream& random,
                AnswerDraft& draft) const noexcept override;
};

const QuestionKind& consent_kind();

}  // namespace haptrial::questions
