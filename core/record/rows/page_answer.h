#pragma once

#include <cstdint>
#include <limits>
#include <span>
#include <string>
#include <vector>

#include "core/record/table/table.h"

namespace haptrial::record {

/// Time at which a page was shown.
enum class PageTime : std::uint8_t { kBefore, kAfterBlock, kAfter };

/// Place at which an answer to a page was given.
enum class AnsweredAt : std::uint8_t { kWindow, kConsole, kTerminal, kVirtual };

/// An answer to an item of a page, a row of /answers; in files whose definition has pages. A
/// participant who goes back and changes an answer adds a row: the last row of an item counts.
struct AnswerRow {
  std::int64_t time_ns{0};  // since the first tick of the session
  PageTime when{PageTime::kBefore};
  std::int32_t block{0};      // after which the page was shown, as in /trials; 0: after none
  std::string questionnaire;  // the page's name
  std::string item;
  double value{std::numeric_limits<double>::quiet_NaN()};  // NaN: the answer is no number
  std::string text;  // the answer as a word, or what was typed
  AnsweredAt source{AnsweredAt::kWindow};
  double duration{0.0};  // from the moment on in which it was asked [s]
};

/// Whether both rows answer the same item, shown at the same time of the session.
bool is_same_item(const AnswerRow& a, const AnswerRow& b);

/// For each row whether it counts: an answer that was changed later does not.
std::vector<bool> standing_answers(std::span<const AnswerRow> rows);

/// Most bytes of a name and of an answer.
inline constexpr std::size_t kPageNameBytes = 64;
inline constexpr std::size_t kPageTextBytes = 1000;

template <>
const Table<AnswerRow>& table_of<AnswerRow>();

}  // namespace haptrial::record
