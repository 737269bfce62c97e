#include "core/bone/hint/hints_beside.h"

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <utility>

namespace haptrial::hint {

void HintsBeside::publish(const HintWatch& watch) noexcept {
  const HintsNow before = now();
  HintsNow next;
  if (shows()) {
    next.kinds = watch.on();
    next.structure = static_cast<std::int8_t>(watch.structure());
  }
  now_.store(next, std::memory_order_relaxed);
  if (chime_ && (next.kinds & ~before.kinds) != 0) {
    chime_->ring();
  }
}

void SteppedHints::after_tick(const HintTick& tick) noexcept {
  if (watch_) {
    watch_->tick(tick, voxels_, shows());
    publish(*watch_);
  }
  voxels_.clear();
}

void SteppedHints::end_pass() {
  if (watch_) {
    watch_->end();
    publish(*watch_);
  }
}

std::vector<record::HintRow> SteppedHints::take() {
  return watch_ ? std::exchange(watch_->rows(), {}) : std::vector<record::HintRow>{};
}

ThreadedHints::ThreadedHints(std::shared_ptr<Chime> chime) : HintsBeside(std::move(chime)) {
  thread_ = std::jthread([this](const std::stop_token& stop) { run(stop); });
}

void ThreadedHints::run(const std::stop_token& stop) {
  constexpr std::chrono::milliseconds kBetween{4};
  while (!stop.stop_requested()) {
    if (work() == 0) {
      std::this_thread::sleep_for(kBetween);
    }
  }
}

/// The voxels of a tick are in their log before the tick is in its own.
std::size_t ThreadedHints::work() {
  waiting_.clear();
  ticks_.flush([this](std::span<const HintTick> ticks) {
    waiting_.insert(waiting_.end(), ticks.begin(), ticks.end());
  });
  if (waiting_.empty()) {
    return 0;
  }
  voxels_.flush([this](std::span<const HintVoxel> voxels) {
    of_ticks_.insert(of_ticks_.end(), voxels.begin(), voxels.end());
  });
  const std::lock_guard lock(mutex_);
  auto next = of_ticks_.cbegin();
  for (const HintTick& tick : waiting_) {
    const auto first = next;
    next = std::find_if(first, of_ticks_.cend(),
                        [&](const HintVoxel& v) { return v.sequence > tick.sequence; });
    if (watch_) {
      watch_->tick(tick, std::span(first, next), shows());
      publish(*watch_);
    }
  }
  of_ticks_.erase(of_ticks_.cbegin(), next);
  done_.fetch_add(waiting_.size(), std::memory_order_release);
  return waiting_.size();
}

void ThreadedHints::begin(std::unique_ptr<HintWatch> watch) {
  const std::lock_guard lock(mutex_);
  watch_ = std::move(watch);
}

void ThreadedHints::settle() {
  const std::uint64_t wanted = ticks_.pushed();
  constexpr std::chrono::milliseconds kBetween{1};
  while (done_.load(std::memory_order_acquire) < wanted) {
    std::this_thread::sleep_for(kBetween);
  }
}

void ThreadedHints::end_pass() {
  settle();
  const std::lock_guard lock(mutex_);
  if (watch_) {
    watch_->end();
    publish(*watch_);
  }
}

std::vector<record::HintRow> ThreadedHints::take() {
  const std::lock_guard lock(mutex_);
  return watch_ ? std::exchange(watch_->rows(), {}) : std::vector<record::HintRow>{};
}

}  // namespace haptrial::hint
