#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/base/definition/schema_forward.h"
#include "core/base/key_press.h"
#include "core/questions/answer_view.h"
#include "core/questions/hint_texts.h"
#include "core/questions/question.h"

namespace haptrial {
class RandomStream;
}

namespace haptrial::questions {

/// Consequence of a key for an answer.
enum class KeyEffect {
  kNothing,  // the key means nothing here
  kChanged,  // the draft is another one
  kGiven     // the answer is given with it
};

/// Traits of a kind that the places know that ask questions.
struct QuestionTraits {
  bool asks{true};            // false: a text that is only read
  bool consents{false};       // to decline ends the session, and only the participant agrees
  bool scored{true};          // a report has the mean of its values
  bool types{false};          // listens to typed characters, not to keys
  bool any_character{false};  // of any script; no list of keys says which
  bool in_trials{true};       // may stand in [response]
  bool marks{false};          // answered by a mark between two ends (move_mark())
};

/// One kind of question: its word and keys, what keys do to an answer, how it is drawn, what a
/// virtual participant answers, and what is recorded. Stateless; any thread. Functions that are
/// noexcept may be called on the servo thread: no allocation, lock, I/O or throw.
class QuestionKind {
 public:
  virtual ~QuestionKind() = default;

  /// Word for the kind, as the console has it: "scale".
  virtual std::string word() const = 0;
  virtual QuestionTraits traits() const noexcept = 0;

  /// Key of a definition that makes a question one of this kind; empty: it is made in another way.
  virtual std::string key() const = 0;
  /// Whether a question is one of this kind.
  virtual bool is_stated(Table& table) const;
  /// Reads that key and those that belong to it. Problems are noted in the table.
  virtual void read(Table& table, Question& question) const = 0;

  /// Keys of the window (KeyPress::key) that have a meaning for the answer, for trials, whose keys
  /// are stated beforehand. A kind that types also gets the characters, each as a press of its own.
  virtual std::vector<int> heard_keys(const Question& question) const = 0;
  /// A key but Enter, which gives a complete answer.
  virtual KeyEffect press(const Question& question, const KeyPress& key,
                          AnswerDraft& draft) const noexcept = 0;
  /// Moves the mark of a kind that marks. @param share  0 at the low end to 1 at the high end
  /// A kind that does not has no mark.
  virtual void move_mark(const Question& question, double share, AnswerDraft& draft) const noexcept;
  /// The share at which the mark of a complete draft is.
  virtual double share_of_mark(const Question& question, const AnswerDraft& draft) const noexcept;
  /// Whether the draft is an answer that is allowed.
  virtual bool is_complete(const Question& question, const AnswerDraft& draft) const noexcept = 0;

  /// The answer of a complete draft.
  virtual Answer answer(const Question& question, const AnswerDraft& draft) const = 0;
  /// The draft of an answer that was given before.
  virtual AnswerDraft draft_of(const Question& question, const Answer& answer) const = 0;
  /// A whole answer in words, from the console or a script.
  /// @returns a sentence if it is not allowed; else empty, and the draft is complete
  virtual std::string parse(const Question& question, const std::string& words,
                            AnswerDraft& draft) const = 0;
  /// The draft as parse() takes it; empty: nothing is chosen or typed.
  virtual std::string written(const Question& question, const AnswerDraft& draft) const = 0;

  virtual AnswerView view(const Question& question, const AnswerDraft& draft) const = 0;
  virtual std::string hint(const Question& question, const HintTexts& texts) const = 0;

  /// A complete answer of a virtual participant.
  /// @param felt  number that it would say in a trial; nothing: it answers at random
  virtual void simulate(const Question& question, std::optional<double> felt, RandomStream& random,
                        AnswerDraft& draft) const noexcept = 0;
};

}  // namespace haptrial::questions
