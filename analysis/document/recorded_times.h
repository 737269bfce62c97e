#pragma once

#include <string>

namespace haptrial::analysis {

/// How long a table recorded a hand, and how densely, if its times are in seconds.
struct RecordedTimes {
  double duration{0.0};  // [s]
  double rate{0.0};      // rows a second [Hz]

  /// Whether a hand is hardly recorded so long, so shortly, so slowly or so fast: its times may be
  /// in another unit.
  bool implausible() const;
  /// "6000 s with 0.1 rows a second"
  std::string words() const;
};

inline constexpr const char* kImplausibleTimes = "implausible times";
inline constexpr const char* kAreTheyMilliseconds =
    "Times are read as seconds and rates as hertz; are these milliseconds?";

}  // namespace haptrial::analysis
