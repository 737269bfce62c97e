#pragma once

#include <memory>
#include <span>
#include <vector>

#include "core/bone/hint/hints_beside.h"
#include "core/bone/simulator/simulator.h"
#include "protocols/bone_drilling/definition/bone_definition.h"

namespace haptrial::record {
class SessionReader;
}

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

}  // namespace haptrial::protocols
