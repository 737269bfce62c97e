#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <span>
#include <string>

#include "analysis/statistics/base/defined.h"

namespace haptrial::analysis {

/// Parts of the score of a recall, in the order of their shares in [analysis].
inline constexpr std::array<const char*, 3> kScoreParts{"cost_share", "force_share", "slope_share"};

/// A share of the score with its 95 % interval.
struct JudgedShare {
  double value{0.0}, low{0.0}, high{0.0};
};

/// Shares of the parts of the score that follow from judgements of curves, and how well they
/// predict judgements of people who were left out.
struct SkillFit {
  std::size_t curves{0}, people{0};
  double r_squared{0.0};       // of participants left out; 0 and below: the parts say nothing
  double low{0.0}, high{0.0};  // its 95 % interval
  double p{1.0};               // of R² as high if judgements were shuffled
  std::array<JudgedShare, 3> shares;  // >= 0, their sum is 1
  bool predicts{false};               // p < 0.05 and R² > 0
  bool determined{false};             // it predicts, and no interval of a share is wider than 1/2
  std::string verdict;                // a sentence
};

/// Fits judgement = a - sum w_j part_j with w >= 0 by least squares. R² is cross-validated, a
/// participant left out at a time; intervals resample participants (999 times) and are widened as
/// Student's t is for as many; p counts 999 shuffles of the judgements, of the means of
/// participants and within each participant. Undefined with fewer than four participants, or if the
/// judgements are all alike.
/// @param parts     (curves x 3) of the score, as TrialScore has them
/// @param judged    (curves) mean judgement, higher is better
/// @param people    (curves) participant of each, any numbers
/// @throws std::invalid_argument when lengths differ
Defined<SkillFit> fit_skill(const Eigen::MatrixX3d& parts, std::span<const double> judged,
                            std::span<const std::size_t> people, std::uint64_t seed);

}  // namespace haptrial::analysis
