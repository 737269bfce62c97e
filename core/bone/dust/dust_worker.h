#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <mutex>
#include <thread>
#include <vector>

#include "core/bone/dust/dust.h"
#include "core/realtime/block_log.h"
#include "core/realtime/latest_value.h"

namespace haptrial::bone {

/// Runs a Dust on a thread of its own, beside a live session.
class DustWorker {
 public:
  /// Which bones there are and where. Called on the worker's thread, once a round; the volumes
  /// outlive the worker.
  using Bones = std::function<void(std::vector<DustBone>&)>;

  /// @param period  of the thread's rounds > 0 [s]
  DustWorker(const DustParameters& parameters, Bones bones, double period = 0.01);
  DustWorker(const DustWorker&) = delete;
  DustWorker& operator=(const DustWorker&) = delete;

  /// Servo thread: no allocation, lock, wait or throw. Nothing is lost: what finds the channel full
  /// is added to the next deposit.
  void deposit(const DustDeposit& deposit) noexcept;
  void place(const DustTools& tools) noexcept;
  /// Waits until the dust has all that was deposited, however far it is behind: two rounds most
  /// often. Any other thread, while the servo thread deposits nothing.
  void settle() noexcept;

  /// The quads of the last round, if they changed since `version`, which is brought up to date.
  /// Any other thread. @returns whether they changed.
  bool quads(std::vector<DustQuad>& quads, std::uint64_t& version) const;
  /// Balance of the last round. Any other thread.
  DustBalance balance() const;

 private:
  void run(const std::stop_token& stop);
  void round(double dt);
  bool send_rest() noexcept;

  Dust dust_;
  Bones bones_;
  double period_;
  realtime::BlockLog<DustDeposit> deposits_{1024, 8};
  realtime::LatestValue<DustTools> tools_;
  DustDeposit unsent_;  // servo thread's; settle()'s while it deposits nothing
  std::vector<DustBone> list_;
  std::vector<DustQuad> drawing_;  // the worker's buffer
  mutable std::mutex mutex_;       // never taken by the servo thread
  std::vector<DustQuad> shown_;
  std::uint64_t shown_version_{0};
  DustBalance shown_balance_;
  std::atomic<std::uint64_t> rounds_{0};
  std::jthread thread_;  // last: it ends before what it uses
};

}  // namespace haptrial::bone
