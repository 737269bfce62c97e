#include "analysis/psychometric/models/paired_comparison.h"

#include <Eigen/Cholesky>
#include <cmath>

#include "analysis/statistics/base/distributions.h"

namespace haptrial::analysis {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

struct Chance {
  double p{0.5};        // F
  double density{0.0};  // its derivative
};

Chance chance(double difference, PairedModel model) {
  if (model == PairedModel::kBradleyTerry) {
    const double p = 1.0 / (1.0 + std::exp(-difference));
    return {p, p * (1.0 - p)};
  }
  const double density = std::exp(-0.5 * difference * difference) / std::sqrt(2.0 * M_PI);
  return {normal_upper_tail(-difference), density};
}

double log_likelihood(const MatrixXd& wins, const VectorXd& worth, PairedModel model) {
  double sum = 0.0;
  for (Eigen::Index i = 0; i < worth.size(); ++i) {
    for (Eigen::Index k = 0; k < worth.size(); ++k) {
      if (wins(i, k) > 0.0) {
        sum += wins(i, k) * std::log(chance(worth[i] - worth[k], model).p);
      }
    }
  }
  return sum;
}

/// A step of Fisher's scoring; the mean of the worths stays.
VectorXd step_from(const MatrixXd& wins, const VectorXd& worth, PairedModel model) {
  const Eigen::Index n = worth.size();
  VectorXd score = VectorXd::Zero(n);
  MatrixXd information = MatrixXd::Constant(n, n, 1.0);
  for (Eigen::Index i = 0; i < n; ++i) {
    for (Eigen::Index k = 0; k < i; ++k) {
      const Chance c = chance(worth[i] - worth[k], model);
      const double scale = c.density / std::max(c.p * (1.0 - c.p), 1e-300);
      const double both = wins(i, k) + wins(k, i);
      const double gain = scale * (wins(i, k) - both * c.p);
      const double known = both * scale * c.density;
      score[i] += gain;
      score[k] -= gain;
      information(i, i) += known;
      information(k, k) += known;
      information(i, k) -= known;
      information(k, i) -= known;
    }
  }
  return information.ldlt().solve(score);
}

/// Whether a chain of counts above 0 leads from every item to every other. Worths have an end
/// exactly if one of choices does (Ford 1957, American Mathematical Monthly 64).
bool are_connected(const MatrixXd& counts) {
  Eigen::ArrayXX<bool> over = counts.array() > 0.0;
  const Eigen::Index n = counts.rows();
  for (Eigen::Index by = 0; by < n; ++by) {
    for (Eigen::Index i = 0; i < n; ++i) {
      for (Eigen::Index k = 0; k < n; ++k) {
        over(i, k) = over(i, k) || i == k || (over(i, by) && over(by, k));
      }
    }
  }
  return over.all();
}

}  // namespace

Defined<VectorXd> worths(const MatrixXd& given, PairedModel model, double added) {
  constexpr int kMostSteps = 200;
  constexpr double kSettled = 1e-12;
  const Eigen::Index n = given.rows();
  if (n < 2) {
    return Undefined{"there are fewer than two items"};
  }
  const MatrixXd presented = given + given.transpose();
  if (!are_connected(presented)) {
    return Undefined{"no chain of presented pairs links all items"};
  }
  // Choices that were added to other pairs would compare items that nobody compared.
  const MatrixXd wins = (presented.array() > 0.0).select(given.array() + added, 0.0);
  if (!are_connected(wins)) {
    return Undefined{"the answers leave the worth of an item without an end"};
  }
  VectorXd worth = VectorXd::Zero(n);
  double likelihood = log_likelihood(wins, worth, model);
  for (int i = 0; i < kMostSteps; ++i) {
    VectorXd step = step_from(wins, worth, model);
    double next = log_likelihood(wins, worth + step, model);
    for (int halvings = 0; !(next >= likelihood) && halvings < 40; ++halvings) {
      step /= 2.0;
      next = log_likelihood(wins, worth + step, model);
    }
    worth += step;
    likelihood = next;
    if (step.cwiseAbs().maxCoeff() < kSettled) {
      return worth;
    }
  }
  return Undefined{"the worths do not settle"};
}

}  // namespace haptrial::analysis
