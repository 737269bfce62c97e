#pragma once

#include <memory>
#include <string>

#include "core/bone/hint/chime.h"
#include "core/bone/nerve/nerve_voice.h"
#include "protocols/bone_drilling/display/bone_sound.h"
#include "protocols/bone_drilling/live_tuning.h"
#include "protocols/interface/trials.h"

namespace haptrial::protocols {

/// The sound of a session of drillings: the drill, and on the same card the nerves' monitor,
/// hints and forbidden regions. Silent where the definition asks for no sound card, nobody is there
/// to hear it, or there is none. Session's thread.
class TrialSound {
 public:
  /// @param definition  outlives the sound  @param tuning  null: nothing is tuned
  TrialSound(const BoneDefinition& definition, const SessionPlace& place,
             const std::shared_ptr<LiveTuning>& tuning);

  /// Null where it is silent, or the definition has nothing that would be heard by it.
  const std::shared_ptr<nerve::NerveVoice>& nerves() const { return nerves_; }
  const std::shared_ptr<hint::Chime>& hints() const { return hints_; }
  const std::shared_ptr<hint::Chime>& regions() const { return regions_; }
  stimulus::Observer* observer() const { return drill_.get(); }

  void listen_to(const std::shared_ptr<const BoneStage>& stage);
  /// Why there is no sound although it is asked for; else empty.
  const std::string& trouble() const { return trouble_; }

 private:
  void open(const BoneDefinition& definition, const SessionPlace& place,
            const std::shared_ptr<LiveTuning>& tuning);

  std::shared_ptr<nerve::NerveVoice> nerves_;
  std::shared_ptr<hint::Chime> hints_;
  std::shared_ptr<hint::Chime> regions_;
  std::unique_ptr<BoneSound> drill_;
  std::string trouble_;
};

}  // namespace haptrial::protocols
