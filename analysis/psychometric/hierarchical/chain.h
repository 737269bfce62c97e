#pragma once

#include <cstdint>
#include <string_view>
#include <vector>

#include "analysis/psychometric/hierarchical/family_state.h"
#include "analysis/psychometric/hierarchical/group_block.h"
#include "analysis/psychometric/hierarchical/hierarchical_model.h"
#include "analysis/psychometric/hierarchical/person_block.h"
#include "analysis/psychometric/hierarchical/t_ellipse.h"
#include "core/base/random.h"

namespace haptrial::analysis::hierarchical {

/// A Markov chain over the posterior of a model. Each sweep draws every person's parameters by an
/// elliptical slice, the means and the spreads of each family given them, and then all means and
/// spreads together, with the people carried along. The last step mixes where answers tell little
/// of a person, the one before it where they tell much.
class Chain {
 public:
  /// Begins near the prior. @param model  outlives the chain
  Chain(const Model& model, std::uint64_t seed, std::string_view name);

  /// Sweeps in which the approximations are learnt and nothing is kept. Once, before sweep().
  void warm_up(std::size_t sweeps);
  void sweep();
  const State& state() const noexcept { return state_; }

 private:
  void fit_people();
  void draw_group_given_people();
  void draw_group_with_people();
  double carry(const Eigen::VectorXd& group);
  void set_likelihoods(const State& state, std::vector<double>& all) const;

  const Model& model_;
  RandomStream random_;
  State state_;
  std::vector<double> likelihood_;  // (series)
  std::vector<PersonBlock> people_;
  GroupBlock group_;
  TEllipse group_ellipse_;
  bool learnt_{false};  // whether the ellipse is there
  State tried_;
  std::vector<double> tried_likelihood_;
  std::uint64_t people_draws_{0};
};

}  // namespace haptrial::analysis::hierarchical
