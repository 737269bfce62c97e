#include "core/stream/marker_thread.h"

#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <utility>

#include "core/realtime/real_time.h"

namespace haptrial::markers {

using record::MarkerOutput;

MarkerThread::MarkerThread(OnsetLog& log, const MarkerOptions& options,
                           std::vector<MarkerMeaning> meanings, MarkerOutputs outputs,
                           std::function<std::int64_t()> now)
    : log_(log),
      options_(options),
      meanings_(std::move(meanings)),
      outputs_(std::move(outputs)),
      now_(std::move(now)) {
  thread_ = std::thread([this] { run(); });
}

MarkerThread::~MarkerThread() {
  stop_.store(true, std::memory_order_relaxed);
  log_.wake();
  thread_.join();
}

/// Runs below the servo thread, which it must not delay, and above everything else.
void MarkerThread::run() {
  const realtime::RealTimeScope urgent(realtime::RealTimeScope::kPriority - 10);
  while (!stop_.load(std::memory_order_relaxed) || !queue_.empty() || high_) {
    log_.wait_until(next_due());
    take_onsets();
    step_line();
  }
}

MarkerThread::Clock::time_point MarkerThread::next_due() const {
  constexpr std::chrono::milliseconds kIdle{200};
  return high_ || !queue_.empty() ? due_ : Clock::now() + kIdle;
}

void MarkerThread::take_onsets() {
  std::vector<TimedOnset> onsets;
  const std::size_t count = log_.take([&](const TimedOnset& onset) { onsets.push_back(onset); });
  if (count == 0) {
    return;
  }
  if (outputs_.serial != nullptr) {
    queue_codes(onsets);
    step_line();  // first: it is the quickest
  }
  for (const TimedOnset& onset : onsets) {
    if (outputs_.other) {
      outputs_.other(onset);
    }
  }
  for (const TimedOnset& onset : onsets) {
    if (outputs_.stream && !onset.over) {
      tell(onset, MarkerOutput::kStream, outputs_.stream(onset));
    }
  }
  done_.fetch_add(count, std::memory_order_release);
}

/// Queues codes in the order of `send` within a tick; onsets that are not sent are left out.
void MarkerThread::queue_codes(std::vector<TimedOnset>& onsets) {
  const auto rank = [this](const TimedOnset& onset) {
    return std::ranges::find(options_.send, onset.onset.what) - options_.send.begin();
  };
  std::vector<TimedOnset> sorted;
  for (const TimedOnset& onset : onsets) {
    if (!onset.over && std::cmp_less(rank(onset), options_.send.size()) &&
        meaning_of(meanings_, onset.onset) != nullptr) {
      sorted.push_back(onset);
    }
  }
  std::ranges::stable_sort(sorted, [&](const TimedOnset& a, const TimedOnset& b) {
    return a.sequence != b.sequence ? a.sequence < b.sequence : rank(a) < rank(b);
  });
  queue_.insert(queue_.end(), sorted.begin(), sorted.end());
  waiting_.store(queue_.size(), std::memory_order_release);
}

/// A line that is full takes the zero later, or the next code in its place; one that has failed has
/// nothing on it.
void MarkerThread::step_line() {
  const auto pulse =
      std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(options_.pulse));
  while ((high_ || !queue_.empty()) && Clock::now() >= due_) {
    if (high_ && !(full_ && !queue_.empty())) {
      full_ = !outputs_.serial->write(0) && outputs_.serial->error() == EAGAIN;
      high_ = full_ && !stop_.load(std::memory_order_relaxed);
      due_ = Clock::now() + pulse;
      continue;
    }
    full_ = false;
    write_code(queue_.front());
    queue_.pop_front();
    waiting_.store(queue_.size(), std::memory_order_release);
    high_ = options_.pulse > 0.0;
    due_ = Clock::now() + pulse;
  }
}

void MarkerThread::write_code(const TimedOnset& onset) {
  const int code = meaning_of(meanings_, onset.onset)->code;
  const bool taken = outputs_.serial->write(static_cast<std::uint8_t>(code));
  tell(onset, MarkerOutput::kSerial, taken);
  if (taken) {
    return;
  }
  if (lost_.fetch_add(1, std::memory_order_relaxed) == 0) {
    const std::lock_guard lock(mutex_);
    trouble_ = fmt::format(
        "serial line {}: {}; the session goes on, and counts the markers that the line does not "
        "take; it is opened again when it is back",
        outputs_.serial->device(), std::strerror(outputs_.serial->error()));
  }
}

void MarkerThread::tell(const TimedOnset& onset, MarkerOutput way, bool taken) {
  const std::int64_t now = now_();
  const std::lock_guard lock(mutex_);
  sent_.push_back({onset, way, taken ? now : -1});
}

std::vector<SentOnset> MarkerThread::take_sent() {
  const std::lock_guard lock(mutex_);
  return std::exchange(sent_, {});
}

bool MarkerThread::wait_until_sent(std::chrono::milliseconds longest) const {
  const auto end = Clock::now() + longest;
  const auto sent = [this] {
    return done_.load(std::memory_order_acquire) >= log_.put_so_far() &&
           waiting_.load(std::memory_order_acquire) == 0;
  };
  while (!sent() && Clock::now() < end) {
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  return sent();
}

std::string MarkerThread::trouble() const {
  const std::lock_guard lock(mutex_);
  return trouble_;
}

}  // namespace haptrial::markers
