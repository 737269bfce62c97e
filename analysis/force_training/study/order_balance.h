#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "analysis/force_training/score/trial_score.h"

namespace haptrial::analysis {

/// How often each condition came at each place of the groups of blocks that hold every condition
/// once, over all participants.
struct OrderBalance {
  bool grouped{false};  // every participant's blocks come in such groups
  std::vector<std::string> conditions;
  std::vector<std::vector<std::size_t>> at_place;  // (conditions x places) groups
  std::vector<std::vector<std::size_t>> after;  // (conditions x conditions) row right after column

  bool places_balanced() const;
  bool sequences_balanced() const;
};

/// Blocks in the order of their trials. Not grouped where blocks have no numbers of their own, or
/// one holds several conditions.
OrderBalance order_balance(std::span<const TrialScore> scores,
                           const std::vector<std::string>& conditions);

/// One sentence: balanced, or the counts that are not.
std::string sentence_of(const OrderBalance& balance);

}  // namespace haptrial::analysis
