#pragma once

#include <limits>
#include <string>
#include <vector>

#include "core/questions/typed_text.h"

namespace haptrial::questions {

class QuestionKind;

/// The kind of a question that says no other: a choice.
const QuestionKind& choice_kind();

/// One answer that may be chosen.
struct Choice {
  std::string value;                                        // what is recorded
  std::string label;                                        // what is shown
  double number{std::numeric_limits<double>::quiet_NaN()};  // recorded as the value; NaN: none
};

/// A question, wherever it is asked: its kind, its words, and the numbers that its kind uses.
struct Question {
  std::string name;  // in files, unlike every other's beside it
  const QuestionKind* kind{&choice_kind()};
  std::string title;                   // may be empty
  std::string text;                    // what is read
  std::vector<Choice> choices;         // empty unless its kind has some
  double low{0.0}, high{0.0};          // bounds of an answer that is a number; both 0: it is none
  double step{1.0};                    // between neighbouring numbers, of a kind that has steps
  std::string low_end, high_end;       // words at the ends of a scale; may be empty
  std::string picture;                 // PNG file, as the definition names it; empty: none
  std::string video;                   // likewise, in the picture's place
  std::size_t most_bytes{kTextBytes};  // of typed words
};

/// An answer while it is being given, plain data of a fixed size.
struct AnswerDraft {
  int chosen{-1};   // choice or step, from 0; -1: none yet
  TypedText typed;  // so far
};

/// An answer as files have it.
struct Answer {
  double value{std::numeric_limits<double>::quiet_NaN()};  // NaN: it is no number
  std::string text;
  std::string reason{};  // of an experimenter who answers in the participant's place
};

}  // namespace haptrial::questions
