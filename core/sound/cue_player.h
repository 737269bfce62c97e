#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "core/sound/cue.h"

namespace haptrial::sound {

/// A sound, or a text that is said, whose first samples the card has taken, or never will.
struct StartedCue {
  std::uint64_t ticket{0};    // that it was started with
  std::int64_t handed_ns{0};  // when, on the clock that the player was given; -1: stilled before
};

/// Plays the sounds of a session on the sound card. Any thread but the servo thread may call; what
/// is started begins with the next 5 ms that the card is given; a sound that meets speech begins 5
/// ms later, when the speech has been cut. Speech is never heard together with a sound: a text
/// waits until the loudspeakers and actuators are quiet, and the masking noise has faded.
class CuePlayer {
 public:
  /// @param seed  of the session  @param now  a clock [ns], asked on the player's thread
  /// @throws RunError in a sentence if there is no such card; InputError as rendered() does
  CuePlayer(const CueSet& set, std::uint64_t seed, std::function<std::int64_t()> now);
  ~CuePlayer();
  CuePlayer(const CuePlayer&) = delete;
  CuePlayer& operator=(const CuePlayer&) = delete;

  /// Renders sounds of the coming trial, which start() takes as those behind the set's own; those
  /// of the trial before are gone, but play to their end. Session's thread: it takes milliseconds.
  void take_varied(const std::vector<Cue>& cues);
  void start(std::size_t cue, std::uint64_t ticket);
  /// Ends what the actuators give; what is started afterwards begins. Loudspeakers go on.
  void still();
  void mask(bool on);
  std::vector<StartedCue> take_started();

  /// Says a text in place of the one before. @param clip  of the text, at CardPlayer::kRate
  void say(std::vector<float> clip, std::uint64_t ticket);
  /// A text that waits is not said any more.
  void forget();
  /// The same, and one that is being said is cut.
  void hush();
  /// Whether a text is being said, or waits.
  bool speaks() const;
  /// Texts that have begun.
  std::vector<StartedCue> take_said();

  /// Whether the card is gone: nothing is played any more.
  bool lost() const;
  /// Whether the limiter acted, the card ran out of samples or was lost, in a sentence; else empty.
  std::string trouble() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace haptrial::sound
