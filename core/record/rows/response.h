#pragma once

#include <cstdint>
#include <limits>
#include <string>

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

}  // namespace haptrial::record
