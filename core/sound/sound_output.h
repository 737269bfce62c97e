#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <string>

#include "core/realtime/latest_value.h"
#include "core/sound/card_player.h"
#include "core/sound/drill_sound.h"

namespace haptrial::sound {

/// Plays a drill on the sound card while it runs, from a thread of its own.
class SoundOutput {
 public:
  /// Adds to the next samples of the drill; called on the player's thread.
  using Mix = std::function<void(std::span<float>)>;

  /// @param device  a name of ALSA's ("default", "hw:0")
  /// @param mix     what else is heard; may be empty
  /// @throws RunError with a sentence where there is no such card, as on a server; a session goes
  /// on without, and its sound can be made from its record (SoundTrack). Else as DrillSound does.
  SoundOutput(SpectrumTable table, const ThinBone& thin, std::uint64_t seed,
              const std::string& device = "default", Mix mix = {});
  SoundOutput(const SoundOutput&) = delete;
  SoundOutput& operator=(const SoundOutput&) = delete;

  /// Sets the state of the drill from now on. Servo thread: no allocation, lock, wait or throw.
  void set(const DrillState& drill) noexcept { latest_.write(drill); }

  /// Counts of CardPlayer. Any thread.
  std::uint64_t played() const noexcept { return player_.played(); }
  std::uint64_t gaps() const noexcept { return player_.gaps(); }
  bool lost() const noexcept { return player_.lost(); }

 private:
  void fill(std::span<float> part) noexcept;

  DrillSound sound_;
  Mix mix_;
  DrillState drill_;  // of the player's thread
  realtime::LatestValue<DrillState> latest_;
  CardPlayer player_;  // last: its thread uses the others
};

}  // namespace haptrial::sound
