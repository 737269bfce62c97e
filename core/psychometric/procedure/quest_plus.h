#pragma once

#include <memory>

#include "core/psychometric/procedure/procedure.h"
#include "core/psychometric/procedure/selection.h"

namespace haptrial::psychometric {

struct QuestStop {
  int trials{0};        // stop at so many; 0: none
  double entropy{0.0};  // stop when that of the posterior is at most this [nat]; 0: none
};

/// QUEST+ (Watson 2017): after each outcome the stimulus that is expected to tell most about the
/// parameters, by Bayes' rule over a grid. Any number of dimensions, parameters and outcomes. Psi
/// (Kontsevich and Tyler 1999) and marginal Psi (Prins 2013) are cases of it: psi_definition().
///
/// The posterior is that of the level really applied, on the grid or not. An answer that is
/// impossible with all parameters leaves it as it was.
class QuestPlus final : public Procedure {
 public:
  /// @throws std::invalid_argument naming the parameter that breaks its bound.
  QuestPlus(std::shared_ptr<const QuestTables> tables, const QuestStop& stop);

  const Level& next() const override;
  /// @throws std::invalid_argument also when the outcome is impossible for all parameters.
  void report(double answer, const Level& applied) override;
  bool finished() const override;
  /// Estimates of each parameter with more than one value: the mean of its posterior with its
  /// standard deviation and central 95 %. An end of the values that the posterior does not exclude
  /// (its probability is above exp(-1.92) of the largest) is an open side, but for a rate's end at
  /// 0; with both ends there is no interval, as the answers do not tell the parameter. Then the
  /// values at the mode of the joint posterior, without one.
  std::vector<Estimate> estimates() const override;

  std::optional<LevelRange> range() const override;

  const std::vector<double>& posterior() const noexcept { return posterior_; }  // (cells)
  /// Posterior of one parameter. @return one probability a value
  std::vector<double> marginal(std::size_t parameter) const;
  double entropy() const;  // of the posterior [nat]
  int trials() const noexcept { return trials_; }
  const QuestTables& tables() const noexcept { return *tables_; }
  /// Stimuli that the last choice compared in double precision.
  std::size_t compared() const noexcept { return selection_.compared(); }

 private:
  void choose();

  std::shared_ptr<const QuestTables> tables_;
  QuestStop stop_;
  StimulusSelection selection_;
  std::vector<double> posterior_;
  std::size_t index_{0};  // of the next stimulus
  Level next_;
  int trials_{0};
  bool sure_{false};  // as stop_.entropy asks for
};

}  // namespace haptrial::psychometric
