#include "analysis/psychometric/models/meta_d.h"

#include <cmath>
#include <numeric>
#include <optional>
#include <stdexcept>
#include <vector>

#include "analysis/psychometric/models/binomial_model.h"
#include "analysis/psychometric/models/detection.h"
#include "analysis/statistics/base/decomposition.h"
#include "analysis/statistics/base/distributions.h"

namespace haptrial::analysis {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double kMostError = 1.0;  // of meta-d'
constexpr double kFar = 40.0;       // a criterion beyond which no evidence lies

/// Ratings of one answer: those that were given, from the lowest evidence to the highest.
struct AnswerSide {
  std::vector<int> noise, signal;
};

AnswerSide answer_side(const RatingCounts& counts, std::size_t first, std::size_t last) {
  AnswerSide side;
  for (std::size_t k = first; k < last; ++k) {
    if (counts.noise[k] + counts.signal[k] > 0) {
      side.noise.push_back(counts.noise[k]);
      side.signal.push_back(counts.signal[k]);
    }
  }
  return side;
}

Index criteria_of_side(const AnswerSide& side) {
  return std::max<Index>(std::ssize(side.noise) - 1, 0);
}

double share_below(double z) { return normal_upper_tail(-z); }

/// Shares of the ratings given stimulus and answer, by meta-d', then the criteria of both sides.
class ConfidenceLikelihood {
 public:
  ConfidenceLikelihood(AnswerSide low, AnswerSide high, double slant)
      : low_(std::move(low)), high_(std::move(high)), slant_(slant) {}

  Index size() const { return 1 + criteria_of_side(low_) + criteria_of_side(high_); }

  std::optional<ScoringPoint> operator()(const VectorXd& p) const {
    ScoringPoint point{0.0, VectorXd::Zero(size()), MatrixXd::Zero(size(), size())};
    for (const bool upper : {false, true}) {
      const AnswerSide& side = upper ? high_ : low_;
      if (criteria_of_side(side) == 0) {
        continue;  // one rating says nothing
      }
      if (!add(p, upper, false, side.noise, point) || !add(p, upper, true, side.signal, point)) {
        return std::nullopt;
      }
    }
    return point;
  }

  /// Evenly shared ratings on either side of the answers' criterion.
  VectorXd first_guess(double meta_d) const {
    VectorXd p(size());
    p[0] = meta_d;
    const Index lows = criteria_of_side(low_);
    for (Index k = 0; k < lows; ++k) {
      p[1 + k] = slant_ * meta_d - 0.5 * static_cast<double>(lows - k);
    }
    for (Index k = 0; k < criteria_of_side(high_); ++k) {
      p[1 + lows + k] = slant_ * meta_d + 0.5 * static_cast<double>(k + 1);
    }
    return p;
  }

 private:
  /// Borders of the ratings of a side, from the lowest.
  VectorXd borders(const VectorXd& p, bool upper) const {
    const Index lows = criteria_of_side(low_);
    VectorXd all(upper ? criteria_of_side(high_) + 2 : lows + 2);
    all[0] = upper ? slant_ * p[0] : -kFar;
    all.segment(1, all.size() - 2) = p.segment(upper ? 1 + lows : 1, all.size() - 2);
    all[all.size() - 1] = upper ? kFar : slant_ * p[0];
    return all;
  }

  /// Shares of the ratings; empty where borders are out of order.
  VectorXd shares(const VectorXd& p, bool upper, bool signal) const {
    const VectorXd all = borders(p, upper);
    const double mean = signal ? 0.5 * p[0] : -0.5 * p[0];
    VectorXd share(all.size() - 1);
    for (Index k = 0; k < share.size(); ++k) {
      if (!(all[k + 1] > all[k])) {
        return {};
      }
      const double from = all[k] - mean, to = all[k + 1] - mean;  // in the tail that keeps digits
      share[k] =
          from > 0.0 ? share_below(-from) - share_below(-to) : share_below(to) - share_below(from);
    }
    share /= share.sum();
    return share.minCoeff() > 1e-300 ? share : VectorXd{};
  }

  bool add(const VectorXd& p, bool upper, bool signal, const std::vector<int>& counts,
           ScoringPoint& point) const {
    constexpr double kStep = 1e-5;
    const VectorXd here = shares(p, upper, signal);
    if (here.size() == 0) {
      return false;
    }
    MatrixXd slopes(here.size(), size());
    for (Index i = 0; i < size(); ++i) {
      VectorXd more = p, less = p;
      more[i] += kStep;
      less[i] -= kStep;
      const VectorXd a = shares(more, upper, signal), b = shares(less, upper, signal);
      if (a.size() == 0 || b.size() == 0) {
        return false;
      }
      slopes.col(i) = (a - b) / (2.0 * kStep);
    }
    const double trials = std::accumulate(counts.begin(), counts.end(), 0.0);
    for (Index k = 0; k < here.size(); ++k) {
      const int count = counts[static_cast<std::size_t>(k)];
      point.value += count * std::log(here[k]);
      point.slope += count / here[k] * slopes.row(k).transpose();
      point.information += trials / here[k] * slopes.row(k).transpose() * slopes.row(k);
    }
    return true;
  }

  AnswerSide low_, high_;
  double slant_;  // criterion of the answers / d'
};

DetectionCounts answers_of(const RatingCounts& counts, std::size_t noise_ratings) {
  DetectionCounts sums;
  for (std::size_t k = 0; k < counts.noise.size(); ++k) {
    (k < noise_ratings ? sums.correct_rejections : sums.false_alarms) += counts.noise[k];
    (k < noise_ratings ? sums.misses : sums.hits) += counts.signal[k];
  }
  return sums;
}

Defined<MetaD> meta_of(const ScoringMaximum& fit, const Detection& answers) {
  const double wide = normal_quantile(0.975);
  const VectorXd first = VectorXd::Unit(fit.at.size(), 0);
  const auto solved = solve_positive(fit.point.information, first);
  const double error = solved ? std::sqrt((*solved)(0, 0)) : kMostError;
  if (!(error < kMostError)) {
    return Undefined{"the ratings do not determine it: its standard error is 1 or more"};
  }
  MetaD meta;
  meta.meta_d = fit.at[0];
  meta.low = meta.meta_d - wide * error;
  meta.high = meta.meta_d + wide * error;
  meta.d_prime = answers.d_prime;
  meta.criterion = answers.criterion;
  meta.ratio = meta.meta_d / meta.d_prime;
  const double ratio_error = std::hypot(error, meta.ratio * answers.error) / meta.d_prime;
  meta.ratio_low = meta.ratio - wide * ratio_error;
  meta.ratio_high = meta.ratio + wide * ratio_error;
  meta.log_likelihood = fit.point.value;
  return meta;
}

}  // namespace

Defined<MetaD> meta_d_prime(const RatingCounts& counts, std::size_t noise_ratings) {
  if (counts.noise.size() != counts.signal.size() || noise_ratings > counts.noise.size()) {
    throw std::invalid_argument("noise and signal must have a count for each rating");
  }
  const Defined<Detection> answers =
      detection(answers_of(counts, noise_ratings), RateCorrection::kLogLinear);
  if (!answers) {
    return Undefined{answers.because()};
  }
  if (!(answers->low > 0.0)) {
    return Undefined{"the answers' d' is not clearly above 0"};
  }
  const ConfidenceLikelihood likelihood(answer_side(counts, 0, noise_ratings),
                                        answer_side(counts, noise_ratings, counts.noise.size()),
                                        answers->criterion / answers->d_prime);
  if (likelihood.size() == 1) {
    return Undefined{"each answer has one rating only"};
  }
  const auto fit = fisher_scoring(std::cref(likelihood), likelihood.first_guess(answers->d_prime));
  if (!fit) {
    return Undefined{"the likelihood of the ratings has no maximum"};
  }
  return meta_of(*fit, *answers);
}

}  // namespace haptrial::analysis
