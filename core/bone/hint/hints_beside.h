#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <mutex>
#include <thread>
#include <vector>

#include "core/bone/hint/chime.h"
#include "core/bone/hint/hint_watch.h"
#include "core/realtime/block_log.h"

namespace haptrial::hint {

/// Hints that a participant sees at an instant.
struct HintsNow {
  std::uint8_t kinds{0};      // bit() of each
  std::int8_t structure{-1};  // as HintWatch::structure()
};

/// Hints beside the servo thread, which hands over every tick of a drilling.
class HintsBeside {
 public:
  /// @param chime  rings when a hint that is shown begins; null: none
  explicit HintsBeside(std::shared_ptr<Chime> chime) : chime_(std::move(chime)) {}
  virtual ~HintsBeside() = default;
  HintsBeside(const HintsBeside&) = delete;
  HintsBeside& operator=(const HintsBeside&) = delete;

  // Session's thread, while no drilling ticks.

  /// Another bone.
  virtual void begin(std::unique_ptr<HintWatch> watch) = 0;
  /// Whether the participant sees hints from now on.
  void let_show(bool shown) noexcept { let_show_.store(shown, std::memory_order_relaxed); }
  /// Hints that are on end with the last tick.
  virtual void end_pass() = 0;

  /// Waits until every tick so far is looked at. Session's thread.
  virtual void settle() = 0;
  /// Hints that ended since the last call. Session's thread.
  virtual std::vector<record::HintRow> take() = 0;
  /// Ticks and voxels that found no room. Any thread.
  virtual std::uint64_t dropped() const noexcept = 0;

  // Servo thread: no allocation, lock or wait (but SteppedHints, on a simulated clock).

  /// Adds a change of a voxel on the tick that after_tick() tells next.
  virtual void voxel(const HintVoxel& voxel) noexcept = 0;
  virtual void after_tick(const HintTick& tick) noexcept = 0;
  HintsNow now() const noexcept { return now_.load(std::memory_order_relaxed); }

 protected:
  bool shows() const noexcept { return let_show_.load(std::memory_order_relaxed); }
  void publish(const HintWatch& watch) noexcept;

 private:
  std::shared_ptr<Chime> chime_;
  std::atomic<bool> let_show_{true};
  std::atomic<HintsNow> now_{HintsNow{}};
};

/// All of it within the tick: a function of the ticks alone. For the simulated clock; allocates.
class SteppedHints final : public HintsBeside {
 public:
  using HintsBeside::HintsBeside;
  void begin(std::unique_ptr<HintWatch> watch) override { watch_ = std::move(watch); }
  void end_pass() override;
  void settle() override {}
  std::vector<record::HintRow> take() override;
  std::uint64_t dropped() const noexcept override { return 0; }
  void voxel(const HintVoxel& voxel) noexcept override { voxels_.push_back(voxel); }
  void after_tick(const HintTick& tick) noexcept override;

 private:
  std::unique_ptr<HintWatch> watch_;
  std::vector<HintVoxel> voxels_;
};

/// Hints on a thread of their own, fed through logs without locks. The records are the same as
/// those of SteppedHints for the same ticks; hints are seen some milliseconds later.
class ThreadedHints final : public HintsBeside {
 public:
  explicit ThreadedHints(std::shared_ptr<Chime> chime);
  void begin(std::unique_ptr<HintWatch> watch) override;
  void end_pass() override;
  void settle() override;
  std::vector<record::HintRow> take() override;
  std::uint64_t dropped() const noexcept override { return ticks_.dropped() + voxels_.dropped(); }
  void voxel(const HintVoxel& voxel) noexcept override { voxels_.push(voxel); }
  void after_tick(const HintTick& tick) noexcept override { ticks_.push(tick); }

 private:
  void run(const std::stop_token& stop);
  std::size_t work();

  realtime::BlockLog<HintTick> ticks_{256, 32};
  realtime::BlockLog<HintVoxel> voxels_{1024, 128};
  std::atomic<std::uint64_t> done_{0};  // ticks
  std::mutex mutex_;                    // of the watch; never taken by the servo thread
  std::unique_ptr<HintWatch> watch_;
  std::vector<HintTick> waiting_;    // the thread's own
  std::vector<HintVoxel> of_ticks_;  // likewise, oldest first
  std::jthread thread_;              // last: it ends before what it uses
};

}  // namespace haptrial::hint
