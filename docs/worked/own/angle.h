#pragma once

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <string>
#include <vector>

#include "core/base/random.h"
#include "core/questions/kind_parts.h"
#include "core/questions/question_kind.h"
#include "core/questions/question_kinds.h"

/// A kind of question, for pages and trials: an angle that arrow keys turn.
namespace own {

using namespace haptrial;
using questions::Answer;
using questions::AnswerDraft;
using questions::AnswerView;
using questions::KeyEffect;
using questions::Question;

/// A direction in steps from 0 degrees: left and right turn it, round and round.
class AngleKind final : public questions::QuestionKind {
 public:
  std::string word() const override { return "angle"; }
  questions::QuestionTraits traits() const noexcept override { return {}; }
  std::string key() const override { return "angle"; }
  void read(Table& table, Question& question) const override {
    questions::steps_schema("angle", "Lowest and highest angle, in degrees", "another answer")
        .read(table, question);
  }
  std::vector<int> heard_keys(const Question&) const override {
    return {KeyPress::kLeft, KeyPress::kRight};
  }
  KeyEffect press(const Question& question, const KeyPress& key,
                  AnswerDraft& draft) const noexcept override {
    const int turn = key.key == KeyPress::kRight ? 1 : key.key == KeyPress::kLeft ? -1 : 0;
    const int count = questions::steps_of(question) + 1;
    draft.chosen = turn == 0 ? draft.chosen : (std::max(draft.chosen, 0) + turn + count) % count;
    return turn != 0 ? KeyEffect::kChanged : KeyEffect::kNothing;
  }
  bool is_complete(const Question& question, const AnswerDraft& draft) const noexcept override {
    return draft.chosen >= 0 && draft.chosen <= questions::steps_of(question);
  }
  Answer answer(const Question& question, const AnswerDraft& draft) const override {
    return {questions::value_of_step(question, draft.chosen), ""};
  }
  AnswerDraft draft_of(const Question& question, const Answer& answer) const override {
    AnswerDraft draft;
    draft.chosen = questions::step_near(question, answer.value);
    return draft;
  }
  std::string parse(const Question& question, const std::string& words,
                    AnswerDraft& draft) const override {
    const auto degrees = questions::number_in(words);
    draft.chosen = degrees ? questions::step_near(question, *degrees) : -1;
    return is_complete(question, draft) ? "" : "the answer is no angle of the dial";
  }
  std::string written(const Question& question, const AnswerDraft& draft) const override {
    return draft.chosen < 0 ? "" : std::to_string(answer(question, draft).value);
  }
  AnswerView view(const Question& question, const AnswerDraft& draft) const override {
    AnswerView view;
    view.figure.push_back({{0.0, 0.0}, {0.0, 1.0}, false});
    if (draft.chosen >= 0) {
      const double turn = answer(question, draft).value * std::numbers::pi / 180.0;
      view.figure.push_back({{0.0, 0.0}, {std::sin(turn), std::cos(turn)}, true});
    }
    return view;
  }
  std::string hint(const Question&, const questions::HintTexts&) const override {
    return "Turn the line with the arrow keys, then press Enter";
  }
  void simulate(const Question& question, std::optional<double> felt, RandomStream& random,
                AnswerDraft& draft) const noexcept override {
    const int count = questions::steps_of(question) + 1;
    draft.chosen = felt ? questions::step_near(question, *felt) % count
                        : static_cast<int>(random.below(static_cast<std::uint64_t>(count)));
  }
};

inline const AngleKind kAngle;

inline void add_angle() { questions::add_kind_of_question(kAngle); }

}  // namespace own
