#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>
#include <vector>

#include "analysis/psychometric/hierarchical/family_state.h"
#include "analysis/psychometric/hierarchical/hierarchical_model.h"
#include "analysis/psychometric/hierarchical/person_block.h"
#include "analysis/psychometric/hierarchical/t_ellipse.h"
#include "core/base/random.h"

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

/// How long chains run. They are extended by half until every number has converged.
struct Sampling {
  std::uint64_t seed{1};
  std::size_t chains{4};           // at least 1
  std::size_t warm_up{300};        // sweeps of each chain
  std::size_t draws{1000};         // of each chain at first, at least 8
  std::size_t most_draws{16'000};  // of each chain at last
  int threads{1};                  // at least 1; results do not depend on it
};

/// Places of a state's numbers in its list: for each family that is sought its means, its
/// spread between people, if it has one its spread within them, and its values. Thresholds and
/// widths are in units of the range of the levels.
struct NumberPlaces {
  explicit NumberPlaces(const Model& model);

  struct Places {
    std::size_t means{0}, between{0}, within{0}, values{0};
  };
  std::array<Places, kFamilies> families;
  std::size_t count{0};
};

/// The numbers of a state in that order.
std::vector<double> numbers_of(const Model& model, const State& state);

/// Chains of one model, each with a random stream of its own, and what they drew.
class Sampler {
 public:
  /// Makes and warms up the chains. @param model  outlives the sampler
  /// @throws std::invalid_argument naming what of `sampling` breaks its bound
  Sampler(const Model& model, const Sampling& sampling);

  void extend(std::size_t draws);  // of each chain
  std::size_t length() const noexcept { return length_; }
  std::size_t chains() const noexcept { return chains_.size(); }
  /// Draws of one number, chain after chain. (chains x length)
  std::vector<double> draws(std::size_t number) const;

 private:
  const Model& model_;
  int threads_;
  std::vector<Chain> chains_;
  std::vector<std::vector<std::vector<double>>> drawn_;  // (chains, length, numbers)
  std::size_t length_{0};
};

}  // namespace haptrial::analysis::hierarchical
