#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "core/bone/hint/chime.h"
#include "core/bone/hint/hints_beside.h"
#include "core/bone/nerve/nerve_beside.h"
#include "core/bone/nerve/nerve_voice.h"
#include "core/bone/simulator/simulator.h"
#include "core/record/read/session_reader_forward.h"
#include "protocols/bone_drilling/definition/bone_definition.h"
#include "protocols/bone_drilling/display/bone_sound.h"
#include "protocols/bone_drilling/live_tuning.h"
#include "protocols/interface/trials.h"

namespace haptrial::protocols {

/// The hints of a session's drillings. Session's thread, but for beside().
class TrialHints {
 public:
  /// @param definition  with hints; outlives this
  /// @param real        on a real clock: beside the servo thread
  /// @param chime       as hint::HintsBeside has it
  TrialHints(const BoneDefinition& definition, bool real, std::shared_ptr<hint::Chime> chime);

  /// @throws InputError if an earlier run of the session went by other safe values
  void check_resumed(const record::SessionReader& file) const;
  /// Another bone, which may have been drilled before.
  /// @param bone  of the definition's
  void watch(std::size_t bone, const bone::Simulator& simulator);

  hint::HintsBeside& beside() noexcept { return *beside_; }
  /// Rows of /hint_limits.
  std::span<const record::HintLimitRow> limits() const noexcept { return limits_; }

 private:
  const BoneDefinition& d_;
  std::vector<record::HintLimitRow> limits_;
  std::unique_ptr<hint::HintsBeside> beside_;
};

/// The watched nerves of a session's drillings. Session's thread, but for beside() and exposures().
class TrialNerves {
 public:
  /// @param definition  with nerves; outlives this
  /// @param voice  of the monitor on the sound card; null: silent
  TrialNerves(const BoneDefinition& definition, const SessionPlace& place,
              const std::shared_ptr<nerve::NerveVoice>& voice);

  /// Another bone, which may have been drilled before.
  /// @param bone  of the definition's
  /// @param used  how many bones the trial has had
  /// @param spent  ticks on this one
  /// @param seed  of the trial's stimuli
  void watch(std::size_t bone, std::int32_t used, std::uint64_t spent, std::uint64_t seed);
  /// All rows up to the last tick.
  void write(SessionFile& file);

  nerve::NerveBeside& beside() noexcept { return *beside_; }
  const nerve::NerveBeside& beside() const noexcept { return *beside_; }
  /// Effects of the tool in the present bone on the nerves.
  nerve::NerveExposures* exposures() noexcept { return exposures_.get(); }
  /// Rows of /nerve_channels.
  std::span<const record::NerveChannelRow> channels() const noexcept { return channels_; }

 private:
  const BoneDefinition& d_;
  std::vector<record::NerveChannelRow> channels_;
  nerve::PulseCurrent pulse_;  // of the probe
  std::unique_ptr<nerve::NerveBeside> beside_;
  std::unique_ptr<nerve::NerveExposures> exposures_;
};

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
