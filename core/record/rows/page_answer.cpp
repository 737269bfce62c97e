#include "core/record/rows/page_answer.h"

#include <algorithm>

namespace haptrial::record {
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
