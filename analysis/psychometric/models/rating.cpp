#include "analysis/psychometric/models/rating.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <optional>
#include <stdexcept>

#include "analysis/psychometric/models/binomial_model.h"
#include "analysis/statistics/base/decomposition.h"
#include "analysis/statistics/base/distributions.h"

namespace haptrial::analysis {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

void check_ratings(const RatingCounts& counts) {
  if (counts.noise.size() != counts.signal.size() || counts.noise.size() < 2) {
    throw std::invalid_argument(
        "noise and signal must have a count for each of two or more ratings");
  }
  for (const auto& kind : {counts.noise, counts.signal}) {
    if (*std::min_element(kind.begin(), kind.end()) < 0) {
      throw std::invalid_argument("counts of a rating must not be negative");
    }
  }
}

double density(double z) { return std::exp(-0.5 * z * z) / std::sqrt(2.0 * std::numbers::pi); }

/// P(Z < z) and its density; 0 and 1 beyond the outer criteria.
struct Below {
  double share;
  double density;
};

/// The likelihood of the parameters a, b, criteria.
class Likelihood {
 public:
  explicit Likelihood(const RatingCounts& counts) : counts_(counts) {}

  Index size() const { return std::ssize(counts_.noise) + 1; }

  /// Nothing where the criteria are out of order or b is not above 0.
  std::optional<ScoringPoint> at(const VectorXd& p) const {
    ScoringPoint point{0.0, VectorXd::Zero(size()), MatrixXd::Zero(size(), size())};
    if (!(p[1] > 0.0) || !add(p, counts_.noise, false, point) ||
        !add(p, counts_.signal, true, point)) {
      return std::nullopt;
    }
    return point;
  }

 private:
  bool add(const VectorXd& p, const std::vector<int>& counts, bool signal,
           ScoringPoint& point) const {
    const Index ratings = std::ssize(counts);
    const double trials = std::accumulate(counts.begin(), counts.end(), 0.0);
    Below last{0.0, 0.0};
    VectorXd by_last = VectorXd::Zero(size());
    for (Index k = 0; k < ratings; ++k) {
      Below here{1.0, 0.0};
      VectorXd by_here = VectorXd::Zero(size());
      if (k + 1 < ratings) {
        const double z = signal ? p[1] * p[2 + k] - p[0] : p[2 + k];
        here = {1.0 - normal_upper_tail(z), density(z)};
        by_here[2 + k] = here.density * (signal ? p[1] : 1.0);
        by_here[0] = signal ? -here.density : 0.0;
        by_here[1] = signal ? here.density * p[2 + k] : 0.0;
      }
      const double share = here.share - last.share;
      if (!(share > 1e-300)) {
        return false;
      }
      const VectorXd by = by_here - by_last;
      point.value += counts[static_cast<std::size_t>(k)] * std::log(share);
      point.slope += counts[static_cast<std::size_t>(k)] / share * by;
      point.information += trials / share * by * by.transpose();
      last = here;
      by_last = by_here;
    }
    return true;
  }

  const RatingCounts& counts_;
};

/// Criteria at the noise's shares, a line through the points of the curve.
VectorXd first_guess(const RatingCounts& counts) {
  const Index ratings = std::ssize(counts.noise);
  VectorXd p(ratings + 1);
  const double noise = std::accumulate(counts.noise.begin(), counts.noise.end(), 0.0);
  const double signal = std::accumulate(counts.signal.begin(), counts.signal.end(), 0.0);
  const double pad = 0.1, pads = pad * static_cast<double>(ratings);  // no share of 0 or 1
  double below_noise = 0.0, below_signal = 0.0, sum = 0.0;
  for (Index k = 0; k + 1 < ratings; ++k) {
    below_noise += counts.noise[static_cast<std::size_t>(k)] + pad;
    below_signal += counts.signal[static_cast<std::size_t>(k)] + pad;
    p[2 + k] = normal_quantile(below_noise / (noise + pads));
    sum += p[2 + k] - normal_quantile(below_signal / (signal + pads));
  }
  p[0] = sum / static_cast<double>(ratings - 1);
  p[1] = 1.0;
  return p;
}

double saturated(const std::vector<int>& counts) {
  const double trials = std::accumulate(counts.begin(), counts.end(), 0.0);
  double sum = 0.0;
  for (const int count : counts) {
    sum += count > 0 ? count * std::log(count / trials) : 0.0;
  }
  return sum;
}

RatingCounts without_unused(const RatingCounts& counts) {
  RatingCounts used;
  for (std::size_t k = 0; k < counts.noise.size(); ++k) {
    if (counts.noise[k] + counts.signal[k] > 0) {
      used.noise.push_back(counts.noise[k]);
      used.signal.push_back(counts.signal[k]);
    }
  }
  return used;
}

BinormalRoc described(const RatingCounts& used, const ScoringMaximum& fit, double level) {
  BinormalRoc roc;
  roc.a = fit.at[0];
  roc.b = fit.at[1];
  const double length = std::sqrt(1.0 + roc.b * roc.b);
  const double z = roc.a / length;
  roc.d_a = std::numbers::sqrt2 * z;
  roc.area = 1.0 - normal_upper_tail(z);
  VectorXd by = VectorXd::Zero(fit.at.size());
  by[0] = 1.0 / length;
  by[1] = -roc.a * roc.b / (length * length * length);
  const auto solved = solve_positive(fit.point.information, by);
  const double error = solved ? std::sqrt(by.dot(solved->col(0))) : 0.0;
  const double wide = normal_quantile(0.5 + 0.5 * level) * error;
  roc.area_low = 1.0 - normal_upper_tail(z - wide);
  roc.area_high = 1.0 - normal_upper_tail(z + wide);
  roc.criteria.assign(fit.at.begin() + 2, fit.at.end());
  roc.log_likelihood = fit.point.value;
  roc.deviance = 2.0 * (saturated(used.noise) + saturated(used.signal) - fit.point.value);
  roc.df = static_cast<int>(used.noise.size()) - 3;
  return roc;
}

}  // namespace

Defined<Roc> rating_roc(const RatingCounts& counts, double level) {
  check_ratings(counts);
  std::vector<double> noise, signal;
  for (std::size_t k = 0; k < counts.noise.size(); ++k) {
    noise.insert(noise.end(), static_cast<std::size_t>(counts.noise[k]), static_cast<double>(k));
    signal.insert(signal.end(), static_cast<std::size_t>(counts.signal[k]), static_cast<double>(k));
  }
  return roc(signal, noise, level);
}

Defined<BinormalRoc> binormal_roc(const RatingCounts& counts, double level) {
  check_ratings(counts);
  const RatingCounts used = without_unused(counts);
  if (used.noise.size() < 3) {
    return Undefined{"fewer than three ratings were given"};
  }
  if (std::accumulate(used.noise.begin(), used.noise.end(), 0) == 0 ||
      std::accumulate(used.signal.begin(), used.signal.end(), 0) == 0) {
    return Undefined{"there are answers of one kind only"};
  }
  const Likelihood likelihood(used);
  const auto fit =
      fisher_scoring([&](const VectorXd& p) { return likelihood.at(p); }, first_guess(used));
  if (!fit) {
    return Undefined{
        "the likelihood has no maximum: the ratings separate signal from noise in part"};
  }
  return described(used, *fit, level);
}

}  // namespace haptrial::analysis
