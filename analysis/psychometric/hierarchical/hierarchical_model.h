#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "analysis/psychometric/fit/likelihood_fit.h"
#include "analysis/psychometric/fit/trial_blocks.h"
#include "core/psychometric/function/sigmoid.h"

namespace haptrial::analysis::hierarchical {

/// The answers of one person under one condition.
struct PersonAnswers {
  std::size_t person{0};           // from 0
  std::size_t condition{0};        // from 0
  std::vector<TrialBlock> blocks;  // at least one
};

/// Prior of a family of parameters: its means over people are normal, its spreads half-t with three
/// degrees of freedom.
struct FamilyPrior {
  double mean{0.0}, deviation{1.0};
  double spread{1.0};  // scale of the half-t
};

/// Parameters of one kind, such as the thresholds: an entry for each person and column. The vector
/// of a person's entries is normal around the means of its columns with the covariance
///
///     within^2 I + between^2 1 1'
///
/// so that people differ as a whole and from condition to condition.
struct Family {
  FamilyPrior prior;
  std::size_t columns{1};           // conditions; 1 for rates
  bool within{false};               // whether somebody has several entries
  std::vector<std::size_t> first;   // (people + 1) where the entries of a person begin
  std::vector<std::size_t> column;  // (entries)

  std::size_t entries() const noexcept { return column.size(); }
};

enum FamilyIndex : std::size_t { kThresholds, kLogWidths, kLapses, kGuesses, kFamilies };

/// Model of the answers of several people under several conditions,
///
///     psi(x) = guess + (1 - guess - lapse) S((x - middle) / range; m, exp(v))
///
/// with a threshold m and a logarithm v of the width for each person and condition, and for each
/// person a lapse rate and, if it is sought, a guess rate: low + (high - low) logistic(l). All four
/// are families. Nothing here is changed by sampling, so threads may share a model.
class Model {
 public:
  /// @param answers  by person; each pair of person and condition once
  /// @param options  as of a fit by maximum likelihood
  /// @throws std::invalid_argument naming what breaks its bound: the options, answers that are not
  /// ordered, fewer than three people, fewer than two levels
  Model(std::vector<PersonAnswers> answers, const LikelihoodOptions& options);

  std::size_t people() const noexcept { return people_; }
  std::size_t conditions() const noexcept { return conditions_; }
  const std::vector<PersonAnswers>& answers() const noexcept { return answers_; }
  /// A family without entries is known: rates that are not sought.
  const Family& family(std::size_t index) const noexcept { return families_[index]; }
  double middle() const noexcept { return middle_; }  // of the levels [axis]
  double range() const noexcept { return range_; }    // highest - lowest level [axis]

  /// Rates of a person.
  struct Rates {
    double lapse{0.0}, guess{0.0};
  };
  /// @param lapse, guess  entries of the families; not read where the rate is known
  Rates rates(double lapse, double guess) const noexcept;

  /// Log-likelihood of a series of answers, without binomial coefficients. No allocation.
  double log_likelihood(std::size_t series, double threshold, double log_width,
                        const Rates& rates) const noexcept;

  /// Slope of the log-likelihood of a series by (m, v, l, g), and Fisher's information.
  struct Curvature {
    std::array<double, kFamilies> slope{};
    std::array<std::array<double, kFamilies>, kFamilies> information{};
  };
  Curvature curvature(std::size_t series, double threshold, double log_width, double lapse,
                      double guess) const noexcept;

  /// Probabilities of an answer 1 in the blocks of a series, in their order.
  std::vector<double> probabilities(std::size_t series, double threshold, double log_width,
                                    const Rates& rates) const;

 private:
  struct Series {  // levels in groups of eight; those without trials fill the last group
    std::vector<double> x, ones, zeros;
    double catch_ones{0.0}, catch_zeros{0.0};
  };
  void set_axis(const LikelihoodOptions& options);
  void set_families();

  std::vector<PersonAnswers> answers_;
  std::vector<Series> series_;
  std::array<Family, kFamilies> families_;
  psychometric::SigmoidCurve curve_;
  Task task_;
  RateBounds lapse_, guess_;
  psychometric::Axis axis_;
  std::size_t people_{0}, conditions_{0};
  double middle_{0.0}, range_{1.0};
};

}  // namespace haptrial::analysis::hierarchical
