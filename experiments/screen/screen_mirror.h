#pragma once

#include <chrono>
#include <mutex>
#include <string>

namespace haptrial::experiments {

class Screen;

/// Small copies of the participant's picture, for the experimenter's console. Nothing is copied
/// while nobody asks; a copy costs the screen's thread some milliseconds, and the rest is done on
/// the thread that asks. Any thread but the servo and the screen's.
class ScreenMirror {
 public:
  /// @param screen  outlives the mirror
  explicit ScreenMirror(Screen& screen) : screen_(screen) {}

  /// A PNG file at most kWidth wide; the one before if it is younger than kPeriod.
  /// @throws RunError if the screen shows no picture for two seconds
  std::string picture();

  static constexpr int kWidth = 640;  // [px]
  static constexpr std::chrono::milliseconds kPeriod{500};

 private:
  Screen& screen_;
  std::mutex mutex_;
  std::string picture_;
  std::chrono::steady_clock::time_point taken_{};
};

}  // namespace haptrial::experiments
