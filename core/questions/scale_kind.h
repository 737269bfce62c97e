#pragma once

#include "core/base/definition/schema.h"
#include "core/questions/question_kind.h"

namespace haptrial::questions {

/// A mark between two ends, moved in steps by the arrow keys or set by typing a number. Where it
/// begins is no answer: it has no place until it is moved.
class ScaleKind final : public QuestionKind {
 public:
  std::string word() const override { return "scale"; }
  QuestionTraits traits() const noexcept override { return {.marks = true}; }
  std::string key() const override { return "scale"; }
  void read(Table& table, Question& question) const override;
  std::vector<int> heard_keys(const Question& question) const override;
  KeyEffect press(const Question& question, const KeyPress& key,
                  AnswerDraft& draft) const noexcept override;
  void move_mark(const Question& question, double share,
                 AnswerDraft& draft) const noexcept override;
  double share_of_mark(const Question& question, const AnswerDraft& draft) const noexcept override;
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

const QuestionKind& scale_kind();

// Parts of a scale that other kinds with steps share.

/// Steps between both ends of a question, at least 1.
int steps_of(const Question& question) noexcept;
/// The number of a step.
double value_of_step(const Question& question, int step) noexcept;
/// The step that is nearest to a number, which may lie beyond both ends.
int step_near(const Question& question, double value) noexcept;
/// The key of a range, under a name of the kind's own, and `step`.
/// @param key, description, otherwise  as KeyDescription has them
Schema<Question> steps_schema(std::string key, std::string description, std::string otherwise);

}  // namespace haptrial::questions
