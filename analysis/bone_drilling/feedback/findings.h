#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "analysis/bone_drilling/feedback/safe_values.h"
#include "analysis/bone_drilling/metrics/metrics.h"
#include "core/bone/drill/sight.h"

namespace haptrial::analysis::drilling {

/// Possible faults of a removal; bits.
enum Fault : std::uint8_t {
  kHiddenFault = 1,  // other bone hid it
  kForceFault = 2,   // more force than nearly all of experts' at this distance of this structure
  kSpeedFault = 4,   // likewise faster
  kVitalFault = 8,   // of a vital structure
};

/// Values of experts.
struct Experts {
  std::vector<std::string> participants;    // each once
  bool simulated{false};                    // any of them
  std::vector<std::string> structures;      // names, as in `profiles`
  std::vector<SafeProfile> profiles;        // by structure
  std::vector<ProcedureSummary> summaries;  // without bones and voxels
};

/// One expert's procedure, as little of it as is needed.
struct ExpertProcedure {
  ProcedureSummary summary;
  std::vector<std::string> structures;
  std::vector<NearestRemoval> removals;  // of these structures
};

/// Parts of a procedure for feedback: metrics near structures in the intervals of SafeOptions.
ExpertProcedure expert_procedure(const Procedure& procedure, const SafeOptions& options,
                                 StudyBones& bones);

/// @param without  a participant who is not to be measured by own procedures; empty: nobody
Experts experts_of(std::span<const ExpertProcedure> procedures, const std::string& without,
                   const SafeOptions& options = {});

/// A procedure and what was wrong with it.
struct Findings {
  ProcedureSummary summary;
  std::vector<std::string> structures;              // vital ones of its bone; none: unknown
  std::vector<NearestRemoval> nearest;              // (removals)
  std::vector<std::uint8_t> faults;                 // (removals) bits of Fault
  std::vector<std::uint8_t> judged;                 // (removals) 1: experts say what is safe there
  std::vector<bone::Voxel> voxels;                  // (removals)
  std::vector<double> times;                        // (removals) of the procedure [s]
  std::vector<std::uint8_t> labels_left;            // of the bone's grid, after all that was taken
  std::shared_ptr<const subject::CavityPlan> plan;  // null: the definition has no [cavity]
  std::vector<std::vector<Eigen::Vector3f>> strokes;  // tip in W, every 20 ms [m]
  Eigen::Isometry3d pose_WB{Eigen::Isometry3d::Identity()};

  std::size_t count(std::uint8_t fault) const;  // removals that have any of these bits
};

/// @param experts  without participants: forces and speeds are not judged
Findings findings_of(const Procedure& procedure, const Experts& experts, StudyBones& bones,
                     const SafeOptions& options = {});

}  // namespace haptrial::analysis::drilling
