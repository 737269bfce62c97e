#pragma once

#include <cstdint>
#include <limits>
#include <span>
#include <string>
#include <vector>

#include "core/record/table/table.h"

namespace haptrial::record {

/// Means by which an answer was given.
enum class ResponseSource : std::uint8_t {
  kNone,
  kKey,
  kButton,
  kPlace,
  kPointer,
  kPedal,
  kMeasured
};

/// One answer, or a number that a stage produced, a row of /responses; in files whose protocol asks
/// or measures something.
struct ResponseRow {
  std::int32_t trial{0};  // as in /trials
  std::int32_t pass{-1};  // row of /trials; -1: none
  std::int32_t interval{
      0};                // of the pass, from 1, after which or about which it was asked; 0: none
  std::string question;  // the definition's name for it
  double value{std::numeric_limits<double>::quiet_NaN()};  // NaN: the answer is no number
  std::string text;                                        // the answer as a word
  std::int32_t correct{-1};                                // 1 right, 0 wrong, -1 not known
  ResponseSource source{ResponseSource::kNone};
  std::int32_t code{-1};  // which key, button or place; -1: none
  double reaction_time{std::numeric_limits<double>::quiet_NaN()};  // [s]; NaN: not measured
  std::uint64_t sequence{0};                                       // of the tick of the answer
  std::int64_t time_ns{0};                                         // of that tick [ns]
};

/// Most bytes of `question` and `text`.
inline constexpr std::size_t kQuestionBytes = 64;
inline constexpr std::size_t kAnswerBytes = 128;

const Table<ResponseRow>& responses_table();

template <>
const Table<ResponseRow>& table_of<ResponseRow>();

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
