#pragma once

#include <span>
#include <vector>

namespace haptrial::sound {

/// An onset in a loopback recording: a marker's pulse, and the sound that follows it.
struct HeardOnset {
  double pulse{0.0};    // when the pulse begins, since the recording's first sample [s]
  double latency{0.0};  // from there to the first sample of the sound [s]
  bool heard{false};    // whether the sound is there
  double left{0.0};     // from the pulse to the first sample that stands out of the noise [s]
  /// How much later that is than for the sound alone, played at `latency`; below 0: something
  /// precedes the sound [s]
  double off{0.0};
};

/// Finds the pulses of a channel by half of the largest one, and after each the place at which the
/// sound fits best: with x the recorded samples and t the sound, behind as much silence as tells a
/// long sound's beginning, the largest of
///
///     (sum t x)² / (sum t² · sum x²)
///
/// over 0.5 s from the pulse on. A sound counts as heard if that is more than a quarter. A sound
/// that grows on its way, as through an actuator at its resonance, fits best after its beginning,
/// and as well as another; but it leaves the noise earlier than the place that fits best says.
/// @param rate  of all three [Hz]  @param sound  as it is played
/// @returns nothing if the channel holds no pulse that stands out of its noise
std::vector<HeardOnset> onset_latencies(std::span<const float> pulses,
                                        std::span<const float> recorded,
                                        std::span<const float> sound, double rate);

}  // namespace haptrial::sound
