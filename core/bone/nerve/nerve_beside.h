#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <thread>
#include <vector>

#include "core/bone/nerve/monitor_buffer.h"
#include "core/bone/nerve/nerve_simulation.h"
#include "core/bone/nerve/nerve_voice.h"
#include "core/realtime/block_log.h"

namespace haptrial::nerve {

/// Further receivers of the monitor's output.
struct NerveListeners {
  std::shared_ptr<MonitorBuffer> buffer;  // a technician's; may be null
  std::shared_ptr<NerveVoice> voice;      // of a sound card; may be null
};

/// The monitor beside the servo thread: gets every tick, makes electromyograms and rows.
class NerveBeside {
 public:
  virtual ~NerveBeside() = default;
  /// Servo thread, every tick in order of sequence.
  virtual void after_tick(const NerveTick& tick) noexcept = 0;
  /// Whether the participant hears a tone now. Servo thread.
  virtual bool tone() const noexcept = 0;
  /// Whether the participant hears the monitor from now on. Any thread.
  virtual void let_hear(bool heard) noexcept = 0;
  /// Rows since the last call. Session's thread.
  virtual record::NerveRows take() = 0;
  /// Ticks that found no room. Any thread.
  virtual std::uint64_t dropped() const noexcept = 0;
  /// Waits, while nothing ticks or for a moment, until every tick so far is in the rows of take().
  virtual void settle() = 0;
};

/// Makes a simulation of the ticks from the first one on: a session that goes on has other noise.
/// @param sequence  of the first tick
using MakeNerveSimulation = std::function<std::unique_ptr<NerveSimulation>(std::uint64_t sequence)>;

/// All of it within the tick: a function of the ticks alone. For the simulated clock; allocates.
class SteppedNerves final : public NerveBeside {
 public:
  explicit SteppedNerves(MakeNerveSimulation make) : make_(std::move(make)) {}

  void after_tick(const NerveTick& tick) noexcept override;
  bool tone() const noexcept override { return tone_; }
  void let_hear(bool heard) noexcept override { heard_ = heard; }
  record::NerveRows take() override;
  std::uint64_t dropped() const noexcept override { return 0; }
  void settle() override {}

 private:
  MakeNerveSimulation make_;
  std::unique_ptr<NerveSimulation> simulation_;
  bool heard_{true};
  bool tone_{false};
};

/// The monitor on a thread of its own, fed through a log without locks. The servo thread only
/// pushes.
class ThreadedNerves final : public NerveBeside {
 public:
  /// @param rate  of ticks [Hz]
  ThreadedNerves(MakeNerveSimulation make, double rate, NerveListeners listeners);

  void after_tick(const NerveTick& tick) noexcept override { ticks_.push(tick); }
  bool tone() const noexcept override { return tone_.load(std::memory_order_relaxed); }
  void let_hear(bool heard) noexcept override { heard_.store(heard, std::memory_order_relaxed); }
  record::NerveRows take() override;
  std::uint64_t dropped() const noexcept override { return ticks_.dropped(); }
  void settle() override;

 private:
  void run(const std::stop_token& stop);
  std::size_t work();
  void follow(const NerveTick& tick, bool heard);
  void speak(bool heard);
  void show(const NerveTick& tick, bool heard);
  void obey();

  MakeNerveSimulation make_;
  double rate_;
  NerveListeners listeners_;
  realtime::BlockLog<NerveTick> ticks_{256, 32};
  std::atomic<bool> heard_{true};
  std::atomic<bool> tone_{false};
  std::atomic<std::uint64_t> done_{0};  // ticks
  std::mutex mutex_;                    // of rows_; never taken by the servo thread
  record::NerveRows rows_;
  // The thread's own.
  std::unique_ptr<NerveSimulation> simulation_;
  std::vector<MonitorColumn> column_;
  std::uint64_t in_column_{0};  // ticks
  std::jthread thread_;         // last: it ends before what it uses
};

/// Whether a tone of any channel is to be heard.
bool has_tone(const NerveSimulation& simulation) noexcept;

}  // namespace haptrial::nerve
