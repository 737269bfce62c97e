#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "analysis/bone_drilling/report/ratings.h"
#include "core/bone/model/bone_model.h"
#include "core/subject/drilling/cavity_plan.h"

namespace haptrial::experiments {

/// Visible result of a finished cavity, and nothing of how it came about.
struct Outcome {
  double planned{0.0};    // bone that the cavity asks to be removed [m3]
  double complete{0.0};   // share of it that is gone
  double beyond{0.0};     // bone gone that should stand, more than a voxel off the plan [m3]
  double injured{0.0};    // of vital structures [m3]
  double roughness{0.0};  // mean height of a place of the cavity over or under those around it [m]
  double carved{0.0};     // the same, places in and beside air cells counting as smooth [m]
};

/// @param standing  (grid.count()) 1: the voxel is still there
Outcome outcome_of(const bone::BoneModel& model, const std::vector<std::uint8_t>& standing,
                   const subject::CavityPlan& plan, const Eigen::Isometry3d& X_WB,
                   const subject::DrillingChart& chart);

/// The rubric of the rating sheet in numbers: 5 less
///
///     4 (0.9 - complete), where that is above 0        parts of the plan are left
///     2 beyond / planned                               removed what should stand
///     0.25 + 2.5 (1 - exp(-injured / 60 mm3)), if any  a vital structure is touched
///     2 (carved - 0.4 mm) / mm, where above 0          not smooth; air cells are nobody's fault
///
/// and at least 1.
double rubric_score(const Outcome& outcome) noexcept;

/// How a simulated rater differs from the rubric.
struct RaterManner {
  std::string name;
  double bias{0.0};   // [points]
  double noise{0.0};  // standard deviation from procedure to procedure >= 0 [points]
};
/// The two of a rehearsal: one a little strict, one lenient and less sure.
std::vector<RaterManner> simulated_raters();

/// The rubric as one rater applies it, in whole points from 1 to 5.
/// @param seed, what  the noise follows from them and the rater's name
double given_score(double rubric, const RaterManner& rater, std::uint64_t seed,
                   const std::string& what);

/// Rates every procedure of a folder of sessions from the bones that are left in the end. Never
/// looks at metrics, groups or the way that a bone was drilled.
/// @throws InputError where a session does not drill or its definition has no [cavity].
std::vector<analysis::drilling::Rating> simulate_ratings(const std::filesystem::path& folder,
                                                         int threads);

}  // namespace haptrial::experiments
