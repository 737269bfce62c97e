#pragma once

#include <vector>

#include "core/device/device.h"

namespace haptrial::device {

/// Plays a recorded hand back, tick by tick, so that a protocol is driven again. What it is told to
/// push goes nowhere: the hand of the recording has already moved.
///
/// A pass that is driven again begins at the very state at which it began in the recording: the
/// hand is held before it until a pass wants to begin, and a pass that wants to begin waits for the
/// hand.
class ReplayDevice final : public Device {
 public:
  /// @param hand      one state a tick, as the recorded device gave it; not empty
  /// @param rate      of the recording and of the loop that replays it > 0 [Hz]
  /// @param recorded  the device of the recording: its limits hold here too
  /// @param starts    of the passes to drive again: places in `hand`, ascending
  /// @throws std::invalid_argument when `hand` is empty, the rate is not above 0 or a start is not
  ///         in its place.
  ReplayDevice(std::vector<PointState> hand, double rate, const DeviceInfo& recorded = {},
               std::vector<std::size_t> starts = {});

  /// Description of the device; it is named "replay of NAME", and is simulated, for nobody is
  /// there.
  const DeviceInfo& info() const noexcept override { return info_; }
  /// @returns false after the last state; trouble() then says so.
  bool read(DeviceReading& reading) noexcept override;
  /// Goes on to the next state.
  bool write(const Wrench& wrench) noexcept override;
  bool ready() noexcept override;
  const char* trouble() const noexcept override;

  double rate() const noexcept { return rate_; }
  double duration() const noexcept;  // [s]
  bool over() const noexcept { return next_ >= hand_.size(); }

 private:
  std::vector<PointState> hand_;
  double rate_;
  DeviceInfo info_;
  std::vector<std::size_t> starts_;
  std::size_t passes_{0};  // begun
  std::size_t next_{0};
};

}  // namespace haptrial::device
