#pragma once

#include <vector>

#include "core/sound/cue.h"

namespace haptrial::protocols {

/// Trials with sounds whose numbers follow from the trial. Session's thread.
class TrialSounds {
 public:
  virtual ~TrialSounds() = default;
  /// The sounds of the pass that make_pass() made last. In its onsets their numbers come behind
  /// those of the definition's own sounds.
  virtual std::vector<sound::Cue> varied_cues() const = 0;
};

/// The sounds of any trials that may have some, or of those that they wrap; none of others.
template <class Trials>
std::vector<sound::Cue> varied_cues_of(const Trials& trials) {
  const auto* sounds = dynamic_cast<const TrialSounds*>(&trials);
  return sounds == nullptr ? std::vector<sound::Cue>{} : sounds->varied_cues();
}

}  // namespace haptrial::protocols
