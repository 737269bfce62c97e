#include "analysis/document/recorded_times.h"

#include <fmt/format.h>

#include "analysis/document/number.h"

namespace haptrial::analysis {
namespace {

// Bounds that a recording of a hand hardly leaves.
constexpr double kLongest = 600.0;  // [s]
constexpr double kShortest = 0.1;   // [s]
constexpr double kSlowest = 10.0;   // [Hz]
constexpr double kFastest = 100e3;  // [Hz]

}  // namespace

bool RecordedTimes::implausible() const {
  return duration > kLongest || duration < kShortest || rate < kSlowest || rate > kFastest;
}

std::string RecordedTimes::words() const {
  return fmt::format("{} s with {} rows a second", number(duration), number(rate));
}

}  // namespace haptrial::analysis
