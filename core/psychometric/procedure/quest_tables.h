#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <vector>

#include "core/base/big_array.h"

namespace haptrial::psychometric {

/// One dimension of the stimulus, or one parameter.
struct QuestDimension {
  std::string name;
  std::vector<double> values;  // finite, at least one
  std::vector<double> prior;   // of a parameter: weights >= 0 of the values; empty: all equal
  bool nuisance{false};        // of a parameter: trials are not spent on knowing it
};

/// Probabilities of all outcomes. @param stimulus, parameters  one number a dimension
/// @param probabilities  to be filled, one number an outcome, each 0 to 1, together 1
using QuestModel =
    std::function<void(const double* stimulus, const double* parameters, double* probabilities)>;

struct QuestDefinition {
  std::vector<QuestDimension> stimulus;    // at least one
  std::vector<QuestDimension> parameters;  // at least one, not all of them nuisances
  std::size_t outcomes{2};                 // 2 to 64
  QuestModel model;
};

/// Everything about a definition that no trial changes: for each stimulus s, outcome o and cell c
/// of the parameter grid the probability L(o | s, c), and h(s, c) = -sum over o of L log L. Several
/// procedures and threads may share one. Cells and stimuli count with the last dimension fastest.
///
/// Memory: 12 (outcomes + 1) bytes for each pair of stimulus and cell.
class QuestTables {
 public:
  /// @throws std::invalid_argument naming what breaks its bound, or the stimulus at which the
  ///         probabilities are not 0 to 1 with sum 1 (within 1e-9)
  explicit QuestTables(QuestDefinition definition);

  std::size_t stimuli() const noexcept { return stimuli_; }
  std::size_t cells() const noexcept { return cells_; }
  std::size_t outcomes() const noexcept { return definition_.outcomes; }
  const QuestDefinition& definition() const noexcept { return definition_; }

  std::vector<double> stimulus(std::size_t index) const;
  std::vector<double> parameters(std::size_t cell) const;
  /// (cells) of one outcome. Row `outcomes()` is h [nat].
  const double* likelihood(std::size_t stimulus, std::size_t outcome) const noexcept;
  /// The likelihood of an outcome at a stimulus that need not be on the grid. @return (cells)
  std::vector<double> likelihood_at(const std::vector<double>& stimulus, std::size_t outcome) const;

  /// (outcomes x padded cells) in single precision, outcomes 0 to outcomes - 2, then h.
  const float* rows(std::size_t stimulus) const noexcept;
  std::size_t padded() const noexcept { return padded_; }  // cells, zeros behind them

  /// Product of the priors, sum 1 (cells).
  const std::vector<double>& prior() const noexcept { return prior_; }
  /// Place of each cell in the grid of the parameters that are no nuisance; empty without one.
  const std::vector<std::size_t>& groups() const noexcept { return groups_; }
  std::size_t group_count() const noexcept { return group_count_; }

 private:
  void fill(std::size_t stimulus);
  void fill_prior();
  void fill_groups();

  QuestDefinition definition_;
  std::size_t stimuli_;
  std::size_t cells_;
  std::size_t padded_;
  BigArray<double> exact_;  // (stimuli x (outcomes + 1) x cells)
  BigArray<float> single_;  // (stimuli x outcomes x padded)
  std::vector<double> prior_;
  std::vector<std::size_t> groups_;
  std::size_t group_count_{0};
};

}  // namespace haptrial::psychometric
