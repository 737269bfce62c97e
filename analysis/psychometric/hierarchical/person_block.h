#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "analysis/psychometric/hierarchical/family_state.h"
#include "analysis/psychometric/hierarchical/hierarchical_model.h"
#include "analysis/psychometric/hierarchical/t_ellipse.h"
#include "core/base/random.h"

namespace haptrial::analysis::hierarchical {

/// All parameters of one person as one block: thresholds, logarithms of widths, lapse and guess
/// rate. The person's likelihood is approximated by a normal one, exp(pull' p - p' information p /
/// 2), that of Fisher's information where the block was fitted; draws are exact whatever it is.
class PersonBlock {
 public:
  PersonBlock(const Model& model, std::size_t person);

  /// Fits the approximation at the most probable block given the families' means and spreads.
  void fit(const State& state);

  /// Takes note of the block, for learn().
  void note(const State& state) { learner_.add(values(state)); }
  /// Learns where the block lies from what was noted since the last time.
  void learn();

  /// Centre and shape of a slice.
  enum class Around {
    kApproximation,  // the normal posterior that the approximation and the families give
    kLearnt,         // the draws of the warm-up; the approximation where there are none
    kPrior,          // the families alone, which no approximation can mislead
  };
  /// Draws the block given the families, and sets it and the likelihoods of the person's series.
  /// @param likelihood  (series of the model) at the state
  void draw(State& state, std::vector<double>& likelihood, Around around, RandomStream& random);

  /// Notes where the block stands within the normal posterior that approximation and families give
  /// it, for carry().
  void begin_carrying(const State& state);
  /// Carries the block along with a change of the families' means and spreads since then: it stays
  /// where it was within that posterior.
  /// @param state  whose means and spreads have changed, and whose values of the person are set
  /// @returns log of the ratio of the values' prior densities, now to then, times the volume that
  /// the map gives to a volume
  /// Source: Murray and Adams 2010, NIPS 23, 1732 (surrogate data).
  double carry(State& state);

 private:
  struct Normal;
  struct Place {  // of a parameter in the state
    std::size_t family, entry;
  };
  Eigen::VectorXd values(const State& state) const;
  void set_values(const Eigen::VectorXd& values, State& state) const;
  void set_prior(const State& state);
  double log_likelihood(const Eigen::VectorXd& at);
  void draw_around(const TEllipse& ellipse, State& state, std::vector<double>& likelihood,
                   RandomStream& random);
  Normal normal_posterior() const;
  double log_prior_of(const State& state) const;
  void set_curvature(const Eigen::VectorXd& at);

  const Model& model_;
  std::size_t person_;
  std::size_t series_;  // the first of the person
  Eigen::Index count_;  // series of the person
  std::vector<Place> places_;
  Eigen::MatrixXd information_;
  Eigen::VectorXd pull_, slope_;
  Eigen::MatrixXd prior_precision_;
  Eigen::VectorXd prior_means_;
  std::vector<double> own_likelihood_;  // (series of the person)
  EllipseLearner learner_;
  TEllipse learnt_;
  bool has_learnt_{false};
  Eigen::VectorXd carried_;      // the block in units of that posterior
  double carried_density_{0.0};  // prior density over volume, as a logarithm
};

}  // namespace haptrial::analysis::hierarchical
