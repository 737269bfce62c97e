#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <deque>
#include <functional>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "core/stream/marker_options.h"
#include "core/stream/onset_log.h"
#include "core/stream/serial_line.h"

namespace haptrial::markers {

/// An onset that was sent, or could not be.
struct SentOnset {
  TimedOnset onset;
  record::MarkerOutput way{record::MarkerOutput::kNone};
  std::int64_t written_ns{-1};  // on the session's clock; -1: it was not taken
};

/// Sends onsets as they come, from a thread of its own that sleeps in between. A code stands on the
/// serial line for the pulse, then a zero for as long, so that codes of one tick follow each other;
/// the other ways do not wait for it.
class MarkerThread {
 public:
  /// Outputs of onsets beside the serial line.
  struct MarkerOutputs {
    SerialLine* serial{nullptr};                    // null: none
    std::function<bool(const TimedOnset&)> stream;  // @returns whether it was taken; empty: none
    std::function<void(const TimedOnset&)> other;   // for what is told in its own way; also ends
  };
  /// @param now  the session's clock [ns]; asked by the thread. All of it outlives the object.
  MarkerThread(OnsetLog& log, const MarkerOptions& options, std::vector<MarkerMeaning> meanings,
               MarkerOutputs outputs, std::function<std::int64_t()> now);
  ~MarkerThread();
  MarkerThread(const MarkerThread&) = delete;
  MarkerThread& operator=(const MarkerThread&) = delete;

  /// Onsets that were sent since the last call, in the order of sending. Any one thread.
  std::vector<SentOnset> take_sent();
  /// Waits until everything that was put has been sent. @returns whether it has. Any thread.
  bool wait_until_sent(std::chrono::milliseconds longest) const;
  /// Codes that the serial line did not take. Any thread.
  std::uint64_t lost() const noexcept { return lost_.load(std::memory_order_relaxed); }
  /// Why, in a sentence; empty while none was lost. Any thread.
  std::string trouble() const;

 private:
  using Clock = std::chrono::steady_clock;

  void run();
  void take_onsets();
  void queue_codes(std::vector<TimedOnset>& onsets);
  void step_line();
  void write_code(const TimedOnset& onset);
  void tell(const TimedOnset& onset, record::MarkerOutput way, bool taken);
  Clock::time_point next_due() const;

  OnsetLog& log_;
  MarkerOptions options_;
  std::vector<MarkerMeaning> meanings_;
  MarkerOutputs outputs_;
  std::function<std::int64_t()> now_;

  // The thread's own.
  std::deque<TimedOnset> queue_;  // for the serial line
  bool high_{false};              // a code stands on the line
  bool full_{false};              // the line has not taken the zero after the code yet
  Clock::time_point due_{};       // when it ends, or when the next may begin

  mutable std::mutex mutex_;  // the two that follow
  std::vector<SentOnset> sent_;
  std::string trouble_;
  std::atomic<std::uint64_t> lost_{0};
  std::atomic<std::uint64_t> done_{0};   // of OnsetLog::put_so_far()
  std::atomic<std::size_t> waiting_{0};  // in the queue
  std::atomic<bool> stop_{false};
  std::thread thread_;
};

}  // namespace haptrial::markers
