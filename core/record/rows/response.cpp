#include "core/record/rows/response.h"

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

}  // namespace haptrial::record
