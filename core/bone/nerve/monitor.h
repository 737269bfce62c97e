#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace haptrial::nerve {

inline constexpr std::size_t kMostChannels = 8;

/// The rules of a monitor of nerve integrity; the defaults are those common in theatres.
struct MonitorParameters {
  double rate{8000.0};         // samples a second [Hz]
  double threshold{100e-6};    // of an event [V]
  double highest{400e-6};      // to which it rises by itself [V]
  double rises_after{10.0};    // of tones without a pause [s]
  double returns_after{15.0};  // of quiet [s]
  double shown_for{5.0};       // on the screen [s]
  double event_gap{0.1};       // quiet that ends an event [s]
  double blanked{0.003};       // after a stimulus [s]
  double lowest_tone{400.0};   // of the first channel [Hz]
  double tone_step{1.25};      // from channel to channel, a factor
  bool artefact_filter{true};  // off: every crossing is an event
};

/// A stretch above the threshold, or one that was taken for an artefact.
struct NerveEvent {
  std::uint64_t first{0};  // sample
  std::uint64_t last{0};
  float peak{0.0f};        // [V]
  float train_time{0.0f};  // of it [s]
  std::uint8_t channel{0};
  bool artefact{false};
};

/// Display and sound of one channel.
struct ChannelState {
  double threshold{0.0};   // now [V]
  bool tone{false};        // an event goes on
  double frequency{0.0};   // of its tone [Hz]
  bool shown{false};       // an event of the last seconds
  double train_time{0.0};  // in all [s]
  std::uint64_t events{0};
  std::uint64_t artefacts{0};
};

/// Looks at electromyograms sample by sample.
///
/// **Events**: a sample beyond the threshold begins one; it ends with `event_gap` of quiet.
/// **Artefacts**: a crossing beside which every other channel reaches half of its threshold within
/// half a millisecond comes from outside; an event of such crossings alone is an artefact. After a
/// stimulus each channel is blind for `blanked`.
/// **Threshold**: where the tone went on for `rises_after` it rises by half, up to `highest`; after
/// `returns_after` of quiet it is as it was.
/// **Trains**: six discharges or more whose intervals lie between 4 and 20 ms and differ by at most
/// a quarter of their mean; their time is counted from the first to the last (train time: below
/// 0.5 s little, above 10 s much postoperative palsy, Prell et al. 2007).
/// Servo thread: no allocation, lock, I/O or throw after the constructor.
class NerveMonitor {
 public:
  /// @param channels  1 to kMostChannels
  /// @throws std::invalid_argument
  NerveMonitor(const MonitorParameters& parameters, std::size_t channels);

  /// One sample of every channel [V]. @param stimulus  a pulse begins with it
  void look(std::span<const float> samples, bool stimulus) noexcept;

  /// Sets the value at which an event of the channel begins from now on, and to which its threshold
  /// returns [V].
  void set_threshold(std::size_t i, double threshold) noexcept;

  const ChannelState& channel(std::size_t i) const noexcept { return state_[i]; }
  std::size_t channels() const noexcept { return state_.size(); }
  std::uint64_t samples() const noexcept { return at_; }
  /// Events that have ended since the last call; at most 64 are kept.
  std::span<const NerveEvent> ended() const noexcept { return {ended_.data(), ended_count_}; }
  void forget_ended() noexcept { ended_count_ = 0; }

 private:
  struct Channel {
    NerveEvent event;
    double base{0.0};  // threshold in quiet [V]
    bool open{false};
    bool genuine{false};       // a crossing of the event was this channel's alone
    std::uint64_t half{0};     // last sample beyond half the threshold, plus 1
    std::uint64_t crossed{0};  // last sample beyond the threshold, plus 1; 0: none
    std::uint64_t blind_until{0};
    std::uint64_t tone_since{0};
    std::uint64_t peak_at{0};  // of the discharge that goes on
    std::uint64_t last_discharge{0};
    std::uint64_t train_first{0};
    double mean_interval{0.0};  // [samples] of the train
    int train_length{0};        // intervals
  };
  void cross(std::size_t i, float value) noexcept;
  void discharge(std::size_t i) noexcept;
  void end_train(std::size_t i) noexcept;
  void end_event(std::size_t i) noexcept;
  void adapt(std::size_t i) noexcept;
  void look_around(std::size_t i) noexcept;
  std::uint64_t samples_of(double seconds) const noexcept;

  MonitorParameters p_;
  std::vector<Channel> channels_;
  std::vector<ChannelState> state_;
  std::array<NerveEvent, 64> ended_{};
  std::size_t ended_count_{0};
  std::uint64_t at_{0};
};

}  // namespace haptrial::nerve
