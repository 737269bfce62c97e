#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/bone/nerve/emg.h"
#include "core/bone/nerve/monitor.h"
#include "core/bone/nerve/nerve_exposures.h"
#include "core/bone/nerve/nerve_rows.h"
#include "core/bone/nerve/stimulator.h"

namespace haptrial::nerve {

/// A channel and whose it is.
struct Channel {
  std::string name;
  std::string nerve;
  std::size_t of{0};  // number of the nerve in the setup
};
std::vector<Channel> channels_of(const NerveSetup& setup);

/// The electromyograms of all channels and the monitor that looks at them, tick by tick: a function
/// of the ticks, the seed and the settings alone. One thread, not the servo's: it allocates rows.
class NerveSimulation {
 public:
  /// @param rate   of ticks [Hz]
  /// @param pulse  the current that the probe's next pulse has; null: nobody changes it
  NerveSimulation(const NerveSetup& setup, double rate, std::uint64_t seed,
                  PulseCurrent pulse = nullptr);

  /// @param heard  the participant hears the monitor at this tick
  void tick(const NerveTick& tick, bool heard);

  /// Sets a threshold from the next tick on. @param channel  one of channels()
  void set_threshold(std::size_t channel, double threshold);
  void set_muted(std::size_t channel, bool muted);
  Stimulator& stimulator() noexcept { return stimulator_; }

  const NerveMonitor& monitor() const noexcept { return monitor_; }
  std::span<const Channel> channels() const noexcept { return channels_; }
  bool muted(std::size_t channel) const noexcept { return muted_[channel]; }
  /// The electromyogram of the last tick [V].
  std::span<const float> samples(std::size_t channel) const noexcept { return samples_[channel]; }
  /// Discharges and events since the rows were cleared.
  record::NerveRows& rows() noexcept { return rows_; }
  /// Events of the last tick, among rows().
  std::span<const record::NerveEventRow> ended() const noexcept;
  double rate() const noexcept { return setup_.monitor.rate; }  // of samples [Hz]

 private:
  void discharge(const NerveTick& tick);
  void plant(const NerveTick& tick, std::size_t channel, const SimulatedDischarge& planted);
  std::optional<std::size_t> branch(std::size_t nerve) noexcept;
  void make(const NerveTick& tick);
  void look(const NerveTick& tick, bool heard);
  void note_settings(std::uint64_t sequence);
  std::uint64_t tick_of(std::uint64_t sample) const noexcept;

  NerveSetup setup_;
  std::vector<Channel> channels_;
  std::size_t samples_a_tick_;
  std::vector<Emg> emg_;  // by channel
  CommonNoise common_;
  RandomStream branches_;
  NerveMonitor monitor_;
  Stimulator stimulator_;
  std::vector<bool> muted_;
  std::vector<record::NerveThresholdRow> settings_;  // by channel, as recorded last
  bool by_technician_{false};
  std::array<std::span<const float>, kMostChannels> samples_{};
  std::uint64_t first_{0};  // sequence of the first tick
  bool begun_{false};
  bool worked_{false};  // burr or suction, on the tick before
  std::vector<std::uint64_t>
      stimulus_;  // by channel: sample after which an answer may come, plus 1
  record::NerveRows rows_;
  std::size_t ended_{0};  // rows of events before the last tick
};

}  // namespace haptrial::nerve
