#pragma once

#include <atomic>
#include <memory>
#include <string>
#include <thread>

#include "core/realtime/latest_value.h"
#include "core/sound/drill_sound.h"

namespace haptrial::sound {

/// Plays a drill on the sound card while it runs, from a thread of its own.
class SoundOutput {
 public:
  /// @param device  a name of ALSA's ("default", "hw:0")
  /// @throws RunError with a sentence where there is no such card, as on a server; a session goes
  /// on without, and its sound can be made from its record (SoundTrack). Else as DrillSound does.
  SoundOutput(SpectrumTable table, const ThinBone& thin, std::uint64_t seed,
              const std::string& device = "default");
  ~SoundOutput();
  SoundOutput(const SoundOutput&) = delete;
  SoundOutput& operator=(const SoundOutput&) = delete;

  /// What the drill does from now on. Servo thread: no allocation, lock, wait or throw.
  void set(const DrillState& drill) noexcept { latest_.write(drill); }

  /// Samples that were handed to the card, and how often it ran out of them. Any thread.
  std::uint64_t played() const noexcept { return played_.load(std::memory_order_relaxed); }
  std::uint64_t gaps() const noexcept { return gaps_.load(std::memory_order_relaxed); }
  /// Whether the card was lost: nothing is played any more. Any thread.
  bool lost() const noexcept { return lost_.load(std::memory_order_relaxed); }

 private:
  struct Card;
  void run();

  DrillSound sound_;
  std::unique_ptr<Card> card_;
  realtime::LatestValue<DrillState> latest_;
  std::atomic<std::uint64_t> played_{0};
  std::atomic<std::uint64_t> gaps_{0};
  std::atomic<bool> lost_{false};
  std::atomic<bool> stop_{false};
  std::thread thread_;
};

}  // namespace haptrial::sound
