#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/bone/nerve/emg.h"
#include "core/bone/nerve/monitor.h"
#include "core/bone/nerve/nerve_rows.h"
#include "core/realtime/block_log.h"

namespace haptrial::nerve {

/// Sound of a tick of the monitor.
struct VoiceTick {
  std::array<float, kMostSamples> raw{};     // of all audible channels [V]
  std::array<float, kMostChannels> tones{};  // frequencies [Hz]; 0: none
  std::uint16_t count{0};                    // samples
};

/// The monitor's sound: the raw electromyogram of every channel, and a tone for each channel with
/// an event, from low to high. One thread pushes, another, the sound card's, mixes.
class NerveVoice {
 public:
  /// @param rate  of the ticks' samples [Hz]  @param card  of the sound [Hz]
  explicit NerveVoice(double rate, double card = 48'000.0);

  /// Never waits: a tick that finds no room is not heard.
  void push(const VoiceTick& tick) noexcept { ticks_.push(tick); }
  /// Adds the next samples to what is there. The sound card's thread; no allocation.
  void mix(std::span<float> part) noexcept;

 private:
  static constexpr std::size_t kAhead = 8192;  // samples of the electromyogram, a power of two
  void take() noexcept;
  float next_raw() noexcept;
  float tones() noexcept;

  double step_;  // samples of the electromyogram a sample of the card
  double card_;
  realtime::BlockLog<VoiceTick> ticks_{64, 32};
  std::array<float, kAhead> raw_{};
  std::uint64_t written_{0};
  double at_{0.0};
  bool runs_{false};
  std::array<double, kMostChannels> frequency_{};
  std::array<double, kMostChannels> phase_{};
  std::array<double, kMostChannels> loudness_{};
};

/// The sound of a nerve monitor from what a session file has of it: its electromyograms, and a tone
/// from the beginning of an event until the monitor closed it. One thread.
class RecordedVoice {
 public:
  struct Record {
    std::vector<record::NerveEventRow> events;          // by tick at which they were closed
    std::vector<record::NerveThresholdRow> thresholds;  // by tick
  };
  /// @param channels  of the monitor  @param card  samples a second of the sound [Hz]
  RecordedVoice(Record record, const MonitorParameters& monitor, std::size_t channels, double card);

  /// The ticks in their order. @param samples  of the tick  @param heard  by the participant
  void tick(std::uint64_t sequence, std::span<const record::EmgRow> samples, bool heard);
  /// Adds the next samples to what is there.
  void mix(std::span<float> part) noexcept { voice_.mix(part); }

 private:
  bool tone(std::size_t channel, std::uint64_t sequence) const;

  Record record_;
  MonitorParameters monitor_;
  std::size_t channels_;
  NerveVoice voice_;
  std::array<bool, kMostChannels> muted_{};
  std::size_t next_setting_{0};
};

}  // namespace haptrial::nerve
