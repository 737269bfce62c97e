#pragma once

#include <cstddef>
#include <vector>

#include "core/psychometric/procedure/information.h"
#include "core/psychometric/procedure/quest_tables.h"

namespace haptrial::psychometric {

/// The stimulus of which the expected entropy of the posterior is least, the first of equal ones
/// (within 1e-15 nat).
///
/// What a stimulus is expected to tell is the information that its outcome and the parameters
/// share:
///
///     I(s) = H(p(s)) - sum over c of posterior(c) h(s, c),   p_o(s) = sum of posterior(c) L(o | s,
///     c)
///
/// and the expected entropy is the present one minus I(s); no logarithm is taken in a sum over
/// cells. The sums run in single precision over all stimuli; those that may be best in view of the
/// bound of the rounding error are compared anew in double precision. With nuisance parameters
/// (Prins 2013) the entropy is that of the posterior over the others; its logarithms cannot be
/// tabled, and the sums run in double precision.
///
/// Source: Watson 2017, J. Vision 17(3):10; Kontsevich and Tyler 1999, Vision Research 39.
class StimulusSelection {
 public:
  /// @throws std::invalid_argument when this machine cannot run the instruction set
  explicit StimulusSelection(const QuestTables& tables,
                             InstructionSet set = best_instruction_set());

  /// @param tables     those of the constructor
  /// @param posterior  (cells), sum 1
  std::size_t best(const QuestTables& tables, const std::vector<double>& posterior);

  /// Stimuli that best() compared in double precision the last time.
  std::size_t compared() const noexcept { return candidates_.size(); }

 private:
  void take_groups(const std::vector<double>& posterior);
  void look_at_all(const QuestTables& tables, const std::vector<double>& posterior);

  RowSums* sums_;
  std::vector<float> weights_;         // (padded)
  std::vector<std::uint32_t> groups_;  // of weights that count
  std::vector<double> row_sums_;       // (outcomes)
  std::vector<double> information_;    // upper bound for each stimulus [nat]
  std::vector<std::size_t> candidates_;
};

/// I(s) in double precision [nat].
double information(const QuestTables& tables, const std::vector<double>& posterior,
                   std::size_t stimulus);
/// Minus the expected entropy of the posterior over the parameters that are no nuisance [nat].
double marginal_information(const QuestTables& tables, const std::vector<double>& posterior,
                            std::size_t stimulus);

}  // namespace haptrial::psychometric
