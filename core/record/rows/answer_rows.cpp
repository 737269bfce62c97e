#include "core/record/rows/answer_rows.h"

#include <algorithm>

namespace haptrial::record {
namespace {

constexpr std::size_t kSourceBytes = 16;

EnumText sources() {
  const auto entry = [](ResponseSource source, const char* word) {
    return EnumText::Entry{static_cast<std::uint8_t>(source), word};
  };
  return EnumText({entry(ResponseSource::kNone, "none"), entry(ResponseSource::kKey, "key"),
                   entry(ResponseSource::kButton, "button"), entry(ResponseSource::kPlace, "place"),
                   entry(ResponseSource::kPointer, "pointer"),
                   entry(ResponseSource::kPedal, "pedal"),
                   entry(ResponseSource::kMeasured, "measured")});
}

}  // namespace

const Table<ResponseRow>& responses_table() {
  using R = ResponseRow;
  using T = Table<R>;
  static const T table(
      {"responses",
       "one row for each answer",
       64,
       RowsOf::kPass,
       {"sequence", "trial", "interval"},
       "responses",
       5},
      {T::column("trial", &R::trial, "1", "trial number, as in /trials"),
       T::column("pass", &R::pass, "1", "row of /trials; -1: none"),
       T::column("interval", &R::interval, "1",
                 "interval of the pass that was asked about, from 1; 0: none"),
       T::text("question", &R::question, kQuestionBytes,
               "what was asked, as the definition names it"),
       T::column("value", &R::value, "1", "the answer as a number; NaN: it is none"),
       T::text("text", &R::text, kAnswerBytes, "the answer as a word"),
       T::column("correct", &R::correct, "1", "1 right, 0 wrong, -1 not known"),
       T::word("source", &R::source, kSourceBytes, sources(),
               "what gave the answer: key, button, place, pointer, pedal, measured or none"),
       T::column("code", &R::code, "1", "which key, button or place; -1: none"),
       T::column("reaction_time", &R::reaction_time, "s",
                 "from the moment on in which an answer was possible; NaN: not measured"),
       T::column("sequence", &R::sequence, "1", "tick of the answer, as in /samples"),
       T::column("time_ns", &R::time_ns, "ns",
                 "of the answer, since the first tick of the session")});
  return table;
}

template <>
const Table<ResponseRow>& table_of<ResponseRow>() {
  return responses_table();
}

namespace {

constexpr std::size_t kPlaceBytes = 16;

template <class E>
EnumText::Entry word_of(E value, const char* word) {
  return {static_cast<std::uint8_t>(value), word};
}

EnumText page_times() {
  return EnumText({word_of(PageTime::kBefore, "before"),
                   word_of(PageTime::kAfterBlock, "after block"),
                   word_of(PageTime::kAfter, "after")});
}

EnumText places() {
  return EnumText({word_of(AnsweredAt::kWindow, "window"), word_of(AnsweredAt::kConsole, "console"),
                   word_of(AnsweredAt::kTerminal, "terminal"),
                   word_of(AnsweredAt::kVirtual, "virtual")});
}

}  // namespace

bool is_same_item(const AnswerRow& a, const AnswerRow& b) {
  return a.when == b.when && a.block == b.block && a.questionnaire == b.questionnaire &&
         a.item == b.item;
}

std::vector<bool> standing_answers(std::span<const AnswerRow> rows) {
  std::vector<bool> standing;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const auto replaces = [&](const AnswerRow& row) { return is_same_item(row, rows[i]); };
    standing.push_back(std::ranges::none_of(rows.subspan(i + 1), replaces));
  }
  return standing;
}

template <>
const Table<AnswerRow>& table_of<AnswerRow>() {
  using R = AnswerRow;
  using T = Table<R>;
  static const T table(
      {"answers",
       "one row for each answer to a page of the definition; a changed answer has a row of its "
       "own, "
       "and the last row of an item counts",
       24,
       RowsOf::kSession,
       {"time_ns"},
       "answers",
       5},
      {T::column("time_ns", &R::time_ns, "ns", "since the first tick of the session"),
       T::word("when", &R::when, kPlaceBytes, page_times(),
               "when the page was shown: before, after block or after"),
       T::column("block", &R::block, "1", "block after which it was shown; 0: after none"),
       T::text("questionnaire", &R::questionnaire, kPageNameBytes, "name of the page"),
       T::text("item", &R::item, kPageNameBytes, "what was asked, as the page names it"),
       T::column("value", &R::value, "1", "the answer as a number; NaN: it is none"),
       T::text("text", &R::text, kPageTextBytes, "the answer as a word, or what was typed"),
       T::word("source", &R::source, kPlaceBytes, places(),
               "where it was answered: window, console, terminal or virtual"),
       T::column("duration", &R::duration, "s", "from the question to the answer")});
  return table;
}

}  // namespace haptrial::record
