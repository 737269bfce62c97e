#include "analysis/psychometric/models/paired_comparison.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "analysis/statistics/base/distributions.h"

namespace haptrial::analysis {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

struct Chance {
  double p{0.5}, other{0.5};  // F, and 1 - F
  double density{0.0};        // F'
  double scale{1.0};          // F' / (F (1 - F))
  double bend{0.0};           // F'' / F'
};

Chance chance(double difference, PairedModel model) {
  if (model == PairedModel::kBradleyTerry) {
    const double p = 1.0 / (1.0 + std::exp(-difference));
    const double other = 1.0 / (1.0 + std::exp(difference));
    return {p, other, p * other, 1.0, other - p};
  }
  const double p = normal_upper_tail(-difference), other = normal_upper_tail(difference);
  const double density = std::exp(-0.5 * difference * difference) / std::sqrt(2.0 * M_PI);
  return {p, other, density, density / std::max(p * other, 1e-300), -difference};
}

/// Adds what is known of the difference between two worths to Fisher's information of all.
void add_known(MatrixXd& information, Eigen::Index i, Eigen::Index k, double known) {
  information(i, i) += known;
  information(k, k) += known;
  information(i, k) -= known;
  information(k, i) -= known;
}

/// A step of Fisher's scoring on the score that takes the bias of first order away; the mean of the
/// worths stays. In the step each pair also counts its leverage as further answers; without them
/// the steps do not settle if there are few answers.
VectorXd step_from(const MatrixXd& wins, const VectorXd& worth, PairedModel model) {
  const Eigen::Index n = worth.size();
  const auto for_each_pair = [&](auto&& visit) {
    for (Eigen::Index i = 0; i < n; ++i) {
      for (Eigen::Index k = 0; k < i; ++k) {
        const Chance c = chance(worth[i] - worth[k], model);
        visit(i, k, c, c.density * c.scale);
      }
    }
  };
  MatrixXd information = MatrixXd::Constant(n, n, 1.0);
  for_each_pair([&](Eigen::Index i, Eigen::Index k, const Chance&, double of_one) {
    add_known(information, i, k, (wins(i, k) + wins(k, i)) * of_one);
  });
  const MatrixXd spread = information.ldlt().solve(MatrixXd::Identity(n, n));
  VectorXd score = VectorXd::Zero(n);
  for_each_pair([&](Eigen::Index i, Eigen::Index k, const Chance& c, double of_one) {
    const double leverage =
        (wins(i, k) + wins(k, i)) * of_one * (spread(i, i) + spread(k, k) - 2.0 * spread(i, k));
    const double gain =
        c.scale * (wins(i, k) * c.other - wins(k, i) * c.p) + 0.5 * leverage * c.bend;
    score[i] += gain;
    score[k] -= gain;
    add_known(information, i, k, leverage * of_one);
  });
  return information.ldlt().solve(score);
}

/// Whether a chain of positive counts leads from the row's item to the column's.
Eigen::ArrayXX<bool> chains(const MatrixXd& counts) {
  Eigen::ArrayXX<bool> over = counts.array() > 0.0;
  const Eigen::Index n = counts.rows();
  for (Eigen::Index by = 0; by < n; ++by) {
    for (Eigen::Index i = 0; i < n; ++i) {
      for (Eigen::Index k = 0; k < n; ++k) {
        over(i, k) = over(i, k) || i == k || (over(i, by) && over(by, k));
      }
    }
  }
  return over;
}

}  // namespace

Defined<VectorXd> worths(const MatrixXd& wins, PairedModel model) {
  constexpr int kMostSteps = 400;
  constexpr double kSettled = 1e-12;
  constexpr double kLongestStep = 1.0;
  const Eigen::Index n = wins.rows();
  if (n < 2) {
    return Undefined{"there are fewer than two items"};
  }
  if (!chains(wins + wins.transpose()).all()) {
    return Undefined{"no chain of presented pairs links all items"};
  }
  VectorXd worth = VectorXd::Zero(n);
  for (int i = 0; i < kMostSteps; ++i) {
    const VectorXd step = step_from(wins, worth, model);
    const double longest = step.cwiseAbs().maxCoeff();
    worth += step / std::max(1.0, longest / kLongestStep);
    if (longest < kSettled) {
      return worth;
    }
  }
  return Undefined{"the worths do not settle"};
}

Eigen::ArrayX<bool> open_worths(const MatrixXd& wins) {
  const Eigen::ArrayXX<bool> over = chains(wins);
  return 2 * (over && over.transpose()).rowwise().count() <= wins.rows();
}

}  // namespace haptrial::analysis
