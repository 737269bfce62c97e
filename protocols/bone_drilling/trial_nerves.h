#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "core/bone/nerve/nerve_beside.h"
#include "protocols/bone_drilling/definition/bone_definition.h"
#include "protocols/interface/trials.h"

namespace haptrial::protocols {

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

}  // namespace haptrial::protocols
