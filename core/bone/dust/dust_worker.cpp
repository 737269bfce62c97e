#include "core/bone/dust/dust_worker.h"

#include <algorithm>
#include <chrono>
#include <stdexcept>

namespace haptrial::bone {
namespace {

constexpr double kMostBehind = 0.05;  // [s] after a delay dust is slower for once, not faster

}  // namespace

DustWorker::DustWorker(const DustParameters& parameters, Bones bones, double period)
    : dust_(parameters), bones_(std::move(bones)), period_(period) {
  if (!(period > 0.0 && period <= 1.0)) {
    throw std::invalid_argument("DustWorker: the period must be from 0 to 1 s");
  }
  thread_ = std::jthread([this](const std::stop_token& stop) { run(stop); });
}

void DustWorker::deposit(const DustDeposit& deposit) noexcept {
  DustDeposit all = deposit;
  all.amount += unsent_.amount;
  unsent_ = all;
  send_rest();
}

/// @returns whether nothing is left
bool DustWorker::send_rest() noexcept {
  if (unsent_.amount > 0.0 && deposits_.push(unsent_)) {
    unsent_.amount = 0.0;
  }
  return unsent_.amount == 0.0;
}

/// The round that runs may have looked at the channel before.
void DustWorker::settle() noexcept {
  for (bool sent = false; !sent;) {
    sent = send_rest();
    const std::uint64_t end = rounds_.load(std::memory_order_acquire) + 2;
    while (rounds_.load(std::memory_order_acquire) < end) {
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
  }
}

void DustWorker::place(const DustTools& tools) noexcept { tools_.write(tools); }

void DustWorker::run(const std::stop_token& stop) {
  using Clock = std::chrono::steady_clock;
  const auto period =
      std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(period_));
  Clock::time_point last = Clock::now();
  while (!stop.stop_requested()) {
    std::this_thread::sleep_until(last + period);
    const Clock::time_point now = Clock::now();
    const double passed = std::chrono::duration<double>(now - last).count();
    last = now;
    round(std::min(passed, std::max(kMostBehind, period_)));
  }
}

void DustWorker::round(double dt) {
  list_.clear();
  bones_(list_);
  dust_.follow(list_);
  deposits_.flush([&](std::span<const DustDeposit> deposits) {
    for (const DustDeposit& deposit : deposits) {
      dust_.deposit(deposit);
    }
  });
  if (DustTools tools; tools_.read(tools)) {
    dust_.place(tools);
  }
  dust_.step(dt);
  const bool changed = dust_.version() != shown_version_;
  if (changed) {
    dust_.quads(drawing_);
  }
  const std::lock_guard lock(mutex_);
  if (changed) {
    shown_.swap(drawing_);
    shown_version_ = dust_.version();
  }
  shown_balance_ = dust_.balance();
  rounds_.fetch_add(1, std::memory_order_release);
}

bool DustWorker::quads(std::vector<DustQuad>& quads, std::uint64_t& version) const {
  const std::lock_guard lock(mutex_);
  if (version == shown_version_) {
    return false;
  }
  quads.assign(shown_.begin(), shown_.end());
  version = shown_version_;
  return true;
}

DustBalance DustWorker::balance() const {
  const std::lock_guard lock(mutex_);
  return shown_balance_;
}

}  // namespace haptrial::bone
