#include "analysis/statistics/relation/cross_validated.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <stdexcept>

#include "analysis/statistics/base/decomposition.h"
#include "analysis/statistics/relation/centered_design.h"
#include "analysis/statistics/relation/correlation.h"

namespace haptrial::analysis {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;
using Rows = std::vector<Index>;

// Everything of a fit that does not depend on lambda.
class RidgePath {
 public:
  RidgePath(const VectorXd& response, const MatrixXd& predictors) {
    const auto n = static_cast<double>(predictors.rows());
    rows_ = n;
    base_.mean = predictors.colwise().mean();
    base_.scale = VectorXd::Zero(predictors.cols());
    base_.intercept = response.mean();
    MatrixXd z = predictors.rowwise() - base_.mean.transpose();
    for (Index j = 0; j < z.cols(); ++j) {
      const double deviation = std::sqrt(z.col(j).squaredNorm() / std::max(1.0, n - 1.0));
      const bool differs = vary_beyond_rounding(
          {predictors.col(j).data(), static_cast<std::size_t>(predictors.rows())});
      base_.scale[j] = differs ? deviation : 0.0;
      z.col(j) *= differs ? 1.0 / deviation : 0.0;
    }
    const ThinSvd svd = thin_svd(z);
    singular_ = svd.singular;
    v_ = svd.v;
    along_ = svd.u.transpose() * (response.array() - base_.intercept).matrix();
  }

  RidgeFit at(double lambda) const {
    RidgeFit fit = base_;
    const VectorXd shrunk =
        singular_.array() * along_.array() / (singular_.array().square() + rows_ * lambda);
    fit.slopes = v_ * shrunk;
    return fit;
  }

 private:
  double rows_{0.0};
  RidgeFit base_;
  VectorXd singular_, along_;
  MatrixXd v_;
};

// Rows of each group, in order of its first row.
std::vector<Rows> rows_by_group(std::span<const std::size_t> groups) {
  std::map<std::size_t, std::size_t> numbers;
  std::vector<Rows> result;
  for (std::size_t i = 0; i < groups.size(); ++i) {
    const auto [at, is_new] = numbers.try_emplace(groups[i], result.size());
    if (is_new) {
      result.emplace_back();
    }
    result[at->second].push_back(static_cast<Index>(i));
  }
  return result;
}

Rows all_but(const std::vector<Rows>& groups, std::size_t left_out, std::size_t also) {
  Rows rows;
  for (std::size_t g = 0; g < groups.size(); ++g) {
    if (g != left_out && g != also) {
      rows.insert(rows.end(), groups[g].begin(), groups[g].end());
    }
  }
  return rows;
}

class Validation {
 public:
  Validation(VectorXd response, const MatrixXd& predictors, std::vector<Rows> groups,
             std::span<const double> penalties)
      : y_(std::move(response)),
        x_(predictors),
        groups_(std::move(groups)),
        penalties_(penalties) {}

  RidgePath path(std::size_t left_out, std::size_t also) const {
    const Rows rows = all_but(groups_, left_out, also);
    return {y_(rows), x_(rows, Eigen::all)};
  }

  // The penalty that predicts best, one group at a time, never looking at `left_out`.
  double best_penalty(std::size_t left_out) const {
    VectorXd errors = VectorXd::Zero(static_cast<Index>(penalties_.size()));
    for (std::size_t g = 0; g < groups_.size(); ++g) {
      if (g != left_out) {
        const RidgePath inner = path(left_out, g);
        for (std::size_t l = 0; l < penalties_.size(); ++l) {
          errors[static_cast<Index>(l)] +=
              (y_(groups_[g]) - inner.at(penalties_[l]).predict(x_(groups_[g], Eigen::all)))
                  .squaredNorm();
        }
      }
    }
    Index best = 0;
    errors.minCoeff(&best);
    return penalties_[static_cast<std::size_t>(best)];
  }

  CrossValidated run() const {
    CrossValidated result;
    result.predicted = result.resubstituted = VectorXd::Zero(y_.size());
    double of_means = 0.0;
    for (std::size_t g = 0; g < groups_.size(); ++g) {
      result.lambdas.push_back(best_penalty(g));
      const RidgeFit fit = path(g, g).at(result.lambdas.back());
      result.predicted(groups_[g]) = fit.predict(x_(groups_[g], Eigen::all));
      of_means += (y_(groups_[g]).array() - fit.intercept).square().sum();
    }
    result.lambda = best_penalty(groups_.size());
    result.fit = path(groups_.size(), groups_.size()).at(result.lambda);
    result.resubstituted = result.fit.predict(x_);
    result.validated = agreement(result.predicted);
    result.resubstitution = agreement(result.resubstituted);
    result.gain = 1.0 - (y_ - result.predicted).squaredNorm() / of_means;
    return result;
  }

 private:
  Agreement agreement(const VectorXd& predicted) const {
    Agreement result;
    const auto view = [](const VectorXd& v) {
      return std::span<const double>(v.data(), static_cast<std::size_t>(v.size()));
    };
    const auto r = pearson_correlation(view(predicted), view(y_));
    result.r = r ? Defined<double>(r->r) : Undefined{r.because()};
    result.rmse = std::sqrt((y_ - predicted).squaredNorm() / static_cast<double>(y_.size()));
    return result;
  }

  VectorXd y_;
  const MatrixXd& x_;
  std::vector<Rows> groups_;
  std::span<const double> penalties_;
};

}  // namespace

VectorXd RidgeFit::predict(const MatrixXd& predictors) const {
  VectorXd result = VectorXd::Constant(predictors.rows(), intercept);
  for (Index j = 0; j < predictors.cols(); ++j) {
    if (scale[j] > 0.0) {
      result += (predictors.col(j).array() - mean[j]).matrix() * (slopes[j] / scale[j]);
    }
  }
  return result;
}

RidgeFit ridge_regression(const VectorXd& response, const MatrixXd& predictors, double lambda) {
  if (response.size() != predictors.rows() || response.size() == 0 || !(lambda > 0.0)) {
    throw std::invalid_argument("ridge_regression: rows, or a lambda that is not above 0");
  }
  return RidgePath(response, predictors).at(lambda);
}

std::vector<double> ridge_penalties() {
  constexpr double kFirst = -2.0, kLast = 3.0;
  constexpr int kADecade = 3;
  std::vector<double> penalties;
  for (int i = 0; i <= static_cast<int>(kLast - kFirst) * kADecade; ++i) {
    penalties.push_back(std::pow(10.0, kFirst + static_cast<double>(i) / kADecade));
  }
  return penalties;
}

Defined<CrossValidated> cross_validated_ridge(std::span<const double> response,
                                              const MatrixXd& predictors,
                                              std::span<const std::size_t> groups,
                                              std::span<const double> penalties) {
  if (static_cast<Index>(response.size()) != predictors.rows() ||
      response.size() != groups.size() || penalties.empty()) {
    throw std::invalid_argument("cross_validated_ridge: lengths differ, or there is no penalty");
  }
  constexpr std::size_t kFewest = 4;
  std::vector<Rows> rows = rows_by_group(groups);
  if (rows.size() < kFewest) {
    return Undefined{"leaving participants out takes at least four of them"};
  }
  if (predictors.cols() == 0) {
    return Undefined{"there is nothing to predict from"};
  }
  const VectorXd y =
      Eigen::Map<const VectorXd>(response.data(), static_cast<Index>(response.size()));
  if (!y.allFinite() || !predictors.allFinite()) {
    return Undefined{"a value is not finite"};
  }
  if (y.minCoeff() == y.maxCoeff()) {
    return Undefined{"what is to be predicted does not vary"};
  }
  return Validation(y, predictors, std::move(rows), penalties).run();
}

}  // namespace haptrial::analysis
