#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <optional>
#include <set>
#include <string>

#include "core/record/rows/session_types.h"

namespace haptrial::experiments {

/// Finds the trials that a participant says to have answered by mistake, with `screen.mistake_key`.
/// A press is about the newest answer at that moment, which may be that of the trial before; while
/// nothing has been asked it is about the present trial, or the last one. Times are those of
/// ServoLoop::elapsed_ns(). Session's thread, but for press().
class ReportedMistakes {
 public:
  /// @param report  called once for each such trial, as "trial 5" or "practice trial 2"
  explicit ReportedMistakes(std::function<void(const std::string& trial)> report);

  /// Any thread. @param time_ns  of the press
  void press(std::int64_t time_ns) noexcept { pressed_ns_.store(time_ns); }
  /// Between two passes. @param last  of them; its trial is 0 before the first one
  void see_to(const record::PassRow& last);
  /// After a pass. @param answered_ns  its first answer; nothing if it has none
  void close_pass(const record::PassRow& pass, std::optional<std::int64_t> answered_ns);

 private:
  void note(const record::PassRow& pass);

  static constexpr std::int64_t kNever = -1;
  std::function<void(const std::string& trial)> report_;
  std::atomic<std::int64_t> pressed_ns_{kNever};
  std::optional<record::PassRow> answered_;  // the last pass with an answer
  std::set<std::string> reported_;           // trials
};

}  // namespace haptrial::experiments
