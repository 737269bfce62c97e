#pragma once

#include <Eigen/Core>
#include <vector>

#include "analysis/psychometric/hierarchical/family_state.h"
#include "analysis/psychometric/hierarchical/hierarchical_model.h"

namespace haptrial::analysis::hierarchical {

/// Means and spreads of all families as one vector.
class GroupBlock {
 public:
  explicit GroupBlock(const Model& model);

  Eigen::Index size() const noexcept { return static_cast<Eigen::Index>(places_.size()); }
  Eigen::VectorXd values(const State& state) const;
  /// Sets means and spreads; the values of people stay.
  void set_values(const Eigen::VectorXd& values, State& state) const;
  /// Log-density of the prior of means and spreads, up to a constant; -infinity for spreads that
  /// are not positive.
  double log_prior(const State& state) const;

 private:
  struct Place {
    std::size_t family, column;
    double FamilyState::*spread;  // null: a mean
  };

  const Model& model_;
  std::vector<Place> places_;
};

}  // namespace haptrial::analysis::hierarchical
