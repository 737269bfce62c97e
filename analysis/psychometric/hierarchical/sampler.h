#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "analysis/psychometric/hierarchical/chain.h"
#include "analysis/psychometric/hierarchical/hierarchical_model.h"

namespace haptrial::analysis::hierarchical {

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
