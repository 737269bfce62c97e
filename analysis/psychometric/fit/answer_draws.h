#pragma once

#include <span>
#include <vector>

#include "analysis/psychometric/fit/trial_blocks.h"

namespace haptrial {
class RandomStream;
}

namespace haptrial::analysis {

/// Draws answers to the levels of blocks: binomial, one uniform number a block.
class AnswerDraws {
 public:
  /// @param shares  of answers 1, one a block, in [0, 1]
  AnswerDraws(std::span<const TrialBlock> blocks, std::span<const double> shares);
  /// Shares from a function.
  AnswerDraws(std::span<const TrialBlock> blocks,
              const psychometric::PsychometricFunction& function);

  /// @param correct  (blocks) gets the numbers of answers 1; no allocation
  void draw(RandomStream& random, std::span<int> correct) const noexcept;

 private:
  std::vector<std::vector<double>> below_;  // (blocks) P(answers 1 <= k), k from 0 to total - 1
};

}  // namespace haptrial::analysis
