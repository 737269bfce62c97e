#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

#include "analysis/bone_drilling/report/validity.h"
#include "tests/support/null_levels.h"

namespace haptrial::test {

/// Results that analyze wrote of a rated validity study.
struct RatedStudy {
  std::vector<analysis::drilling::ProcedureSummary> procedures;  // without voxels
  std::vector<analysis::drilling::Rating> ratings;
  analysis::drilling::ValidityPlan plan;  // groups in order of appearance; novices are no experts
};

/// @param folder  with metrics.csv and ratings.csv
RatedStudy read_rated_study(const std::filesystem::path& folder);

enum class NullLabels {
  kGroups,   // who is in which group, permuted over participants
  kRatings,  // whose ratings are whose, all of a participant's together
};

const char* name_of(NullLabels labels);

/// The tests of as many reports on relabelled studies. Every scheme keeps what procedures of one
/// participant share.
std::vector<NullLevel> null_validity(const RatedStudy& study, NullLabels labels,
                                     std::size_t replications, std::uint64_t seed, int threads);

/// The region's contrast: made-up procedures of people who differ in what they remove, for no
/// group's sake, with half of the people called experts.
std::vector<NullLevel> null_regions(std::size_t replications, std::uint64_t seed, int threads);

/// Ratings of 4 experts and 11 novices with the same mean, of whom the experts differ three times
/// as much from each other.
std::vector<NullLevel> null_spreads(std::size_t replications, std::uint64_t seed, int threads);

}  // namespace haptrial::test
