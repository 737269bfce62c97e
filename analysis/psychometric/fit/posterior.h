#pragma once

#include <array>
#include <optional>
#include <span>
#include <vector>

#include "analysis/psychometric/fit/fitted_function.h"
#include "analysis/psychometric/fit/prior.h"
#include "analysis/psychometric/fit/trial_blocks.h"

namespace haptrial::analysis {

/// Values of each parameter; one value is a fixed parameter.
using GridAxes = std::array<std::vector<double>, kDimensions>;

/// Trapezoid weights of rising values; 1 for a single one.
std::vector<double> trapezoid_weights(std::span<const double> values);

/// Posterior density of a psychometric function with beta-binomial answers, up to a constant. With
/// v = 1 / eta^2 - 1 a block of n trials at p has the likelihood
///
///     B(k + p v, n - k + (1 - p) v) / B(p v, (1 - p) v)   (eta = 0: p^k (1 - p)^(n - k))
///
/// computed as products of (p + j / v) and (1 - p + j / v) over (1 + j / v), so that it is
/// continuous at eta = 0. A p or 1 - p between 0 and 1e-35 counts as 1e-35.
class PsychometricPosterior {
 public:
  /// @param shape  sigmoid, axis, share, tail and direction; the rest of it is not read
  /// @param fixed  a parameter with a value here has no prior
  /// @throws std::invalid_argument naming share or tail, or when a level is not on the axis.
  PsychometricPosterior(const psychometric::PsychometricParameters& shape, Task task,
                        std::span<const TrialBlock> blocks, const PsychometricPrior& prior,
                        const std::array<std::optional<double>, kDimensions>& fixed);

  /// Logarithm at one place; -infinity where it is 0.
  double log_density(const FittedParameters& parameters) const;
  /// Mass of each cell by trapezoid weights over the largest density, eta running fastest.
  struct Masses {
    std::vector<double> cells;  // product of the lengths of the axes
    double log_largest{0.0};    // log_density of the largest density on the grid
    double sum{0.0};            // of the cells
    std::array<std::size_t, kDimensions> largest{};  // its place
  };
  /// @throws std::invalid_argument when the density is 0 on the whole grid.
  Masses on(const GridAxes& axes, int threads) const;

 private:
  struct Table;
  struct Slice;
  double log_prior(Dimension dimension, double value) const;
  bool multiply(const Table& table, double lapse, double guess, Slice& slice) const;
  void fill(const GridAxes& axes, const Table& table, std::size_t threshold, double* out) const;

  psychometric::SigmoidCurve curve_;
  Task task_;
  std::vector<TrialBlock> blocks_;
  std::vector<double> coordinates_;
  PsychometricPrior prior_;
  std::array<bool, kDimensions> fixed_{};
  int most_answers_{0};
};

}  // namespace haptrial::analysis
