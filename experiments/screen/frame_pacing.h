#pragma once

#include <chrono>
#include <cstdint>
#include <string>

#include "core/record/rows/session_types.h"

namespace haptrial::experiments {

using ScreenClock = std::chrono::steady_clock;  // CLOCK_MONOTONIC, as the servo loop's

/// Nanoseconds of the screen's clock.
std::int64_t screen_ns() noexcept;

/// How often pictures come, and who says so.
struct AgreedPace {
  double rate{0.0};            // [Hz]
  bool refresh_locked{false};  // the swap waits for the monitor; else a timer sets the pace
  std::string notice;          // one sentence; empty where the refresh sets the pace
};

/// The display sets the pace, if it keeps to the rate that its monitor states; else a timer does.
/// @param wants_lock    what the definition asks for
/// @param monitor_rate  0: the monitor does not say [Hz]
/// @param interval      between pictures that were shown as fast as they could be [s]
/// @param timer_rate    where the monitor does not say [Hz]
AgreedPace agreed_pace(bool wants_lock, double monitor_rate, double interval, double timer_rate);

/// Decides when the next picture is due, and which refreshes passed without one. A timer's picture
/// that is late is due at once.
class Pace {
 public:
  explicit Pace(const AgreedPace& agreed, std::int64_t now_ns = screen_ns());

  /// Waits before a picture is drawn; returns at once if the swap waits for the refresh.
  void wait();
  /// The part of wait() that decides, for any clock.
  /// @returns when the next picture is due; `now_ns` if at once
  std::int64_t next_due(std::int64_t now_ns);
  /// Notes that the display has a picture.
  record::FrameRow shown(std::int64_t draw_ns, std::int64_t now_ns = screen_ns());

 private:
  double period_ns_;
  bool locked_;
  std::int64_t last_;
  double due_;
  double late_{0.0};        // that is not counted as missed yet [periods]
  std::int32_t missed_{0};  // before the next picture
};

}  // namespace haptrial::experiments
