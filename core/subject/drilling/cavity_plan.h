#pragma once

#include <cstdint>
#include <vector>

#include "core/subject/drilling/cavity_chart.h"

namespace haptrial::subject {

/// Verdict of the plan of a cavity on a voxel.
enum class PlanPart : std::uint8_t {
  kAir,      // there never was bone
  kPlanned,  // is to be removed, and a burr reaches it
  kMargin,   // plain bone within a voxel of the plan: nobody is blamed for it
  kBeyond,   // plain bone that should stand
  kVital,    // of a vital structure
};

/// The plan of a cavity for every voxel of a bone. A simulated rater, tables, pages and the console
/// count by it.
struct CavityPlan {
  std::vector<PlanPart> parts;  // (grid.count())
  std::uint64_t planned{0};     // voxels that are to be removed
};

/// @param depths  (grid.count()) of cavity_depths(): from 0 where a voxel is to be removed
CavityPlan plan_of(const bone::BoneModel& model, const std::vector<float>& depths);

/// Depth of each voxel that a plan asks for, as cavity_depths(), as far as the smallest burr
/// reaches, since corners that no burr enters are not asked for. Takes a fraction of a second.
/// @param burr_radius  of the smallest burr > 0 [m]
/// @throws InputError as make_chart() does.
std::vector<float> planned_depths(const bone::BoneModel& model, const Eigen::Isometry3d& X_WB,
                                  const CavityParameters& cavity, double burr_radius);

/// Whether a voxel is gone when the cavity is removed down to a share of its depth.
/// @param depth    of the voxel, below 0 where it stays @param deepest  of all
bool is_gone_at(float depth, double share, float deepest) noexcept;

/// The plan as far as the smallest burr reaches. Likewise.
CavityPlan plan_cavity(const bone::BoneModel& model, const Eigen::Isometry3d& X_WB,
                       const CavityParameters& cavity, double burr_radius);

}  // namespace haptrial::subject
