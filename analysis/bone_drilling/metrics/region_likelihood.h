#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace haptrial::analysis::drilling {

/// The region that one procedure removed, for naive Bayes.
struct RemovedRegion {
  std::string participant;
  bool expert{false};
  std::span<const std::uint32_t> voxels;  // ascending, each once; all of one grid
};

enum class RegionTraining : std::uint8_t {
  kResubstitution,   // on everyone, those scored among them, as the source
  kLeaveSubjectOut,  // without the participant scored
  /// Mean over each participant of the other group, with that one and the scored one left out: so
  /// both groups are as large whoever is scored, and the score does not say who was left out.
  kLeavePairOut,
};

enum class RegionTerms : std::uint8_t {
  kAll,      // every voxel, removed or left: the likelihood of the model
  kRemoved,  // removed voxels only, as the source
};

/// log(p_expert / p_novice) of one procedure:
///
///     p_g(v) = (k_g(v) + alpha_g) / (n_g + 2 alpha_g),    alpha_g = n_g / n
///     kAll:      sum over removed v of log p_e/p_n + over others of log (1 - p_e)/(1 - p_n)
///     kRemoved:  the first sum alone
///
/// k_g(v) of a group's n_g procedures removed the voxel; n is the mean of both n_g, so that groups
/// of one size have Laplace's rule (a pseudo-count of 1) and a voxel that nobody removed says
/// nothing with any sizes.
/// Not defined where the training leaves a group without procedures.
/// Source: Morris 2006, §3.5.3.
/// @returns (regions). @throws std::invalid_argument for a participant in both groups.
std::vector<std::optional<double>> region_log_ratios(std::span<const RemovedRegion> regions,
                                                     RegionTraining training,
                                                     RegionTerms terms = RegionTerms::kAll);

/// One procedure, scored each way. The first is the default: kLeavePairOut, kAll.
struct RegionScores {
  std::optional<double> score;
  std::optional<double> leave_subject_out;  // kAll
  std::optional<double> resubstitution;     // kAll
  std::optional<double> removed_only;       // kLeavePairOut, kRemoved
  std::optional<double> removed_leave_subject_out;
  std::optional<double> removed_resubstitution;  // as the source
};

std::vector<RegionScores> region_scores(std::span<const RemovedRegion> regions);

/// Whether experts have higher scores than novices, by what the labels are worth: scores share
/// their training and are not independent, so a t-test of them is not exact; this is, because all
/// is done again with the labels of participants dealt out anew.
struct RegionLabelTest {
  double gap{0.0};  // mean over experts of their mean score, minus that over novices
  double p{1.0};    // (1 + rounds with a gap at least as large) / (1 + rounds), one-tailed
  int rounds{0};
};

/// Test of labels with kLeavePairOut. Nothing where a score is not defined.
/// @param rounds  >= 1; the seed decides on the dealing
/// @throws std::invalid_argument as region_log_ratios() does.
std::optional<RegionLabelTest> region_label_test(std::span<const RemovedRegion> regions,
                                                 std::uint64_t seed, int rounds = 199,
                                                 RegionTerms terms = RegionTerms::kAll);

}  // namespace haptrial::analysis::drilling
