#include "analysis/psychometric/hierarchical/t_ellipse.h"

namespace haptrial::analysis::hierarchical {
namespace {

constexpr Eigen::Index kTailDegrees = 4;
constexpr double kLeastVariance = 1e-12;

}  // namespace

double TEllipse::log_density(const Eigen::VectorXd& at) const {
  constexpr double kAll = static_cast<double>(kTailDegrees);
  const double distance = (root_.triangularView<Eigen::Upper>() * (at - centre_)).squaredNorm();
  return -0.5 * (kAll + static_cast<double>(at.size())) * std::log1p(distance / kAll);
}

Eigen::VectorXd TEllipse::partner(const Eigen::VectorXd& at, RandomStream& random) const {
  const double distance = (root_.triangularView<Eigen::Upper>() * (at - centre_)).squaredNorm();
  double squares = 0.0;  // chi-square: the t distribution is a mixture of normal ones
  for (Eigen::Index i = 0; i < at.size() + kTailDegrees; ++i) {
    const double z = random.normal();
    squares += z * z;
  }
  Eigen::VectorXd noise(at.size());
  for (double& z : noise) {
    z = random.normal() * std::sqrt((static_cast<double>(kTailDegrees) + distance) / squares);
  }
  return root_.triangularView<Eigen::Upper>().solve(noise);
}

void EllipseLearner::add(const Eigen::VectorXd& draw) {
  if (count_ == 0) {
    sum_ = Eigen::VectorXd::Zero(draw.size());
    products_ = Eigen::MatrixXd::Zero(draw.size(), draw.size());
  }
  ++count_;
  sum_ += draw;
  products_ += draw * draw.transpose();
}

TEllipse EllipseLearner::learnt() const {
  const auto count = static_cast<double>(count_), size = static_cast<double>(sum_.size());
  const Eigen::VectorXd centre = sum_ / count;
  Eigen::MatrixXd covariance = products_ / count - centre * centre.transpose();
  const Eigen::VectorXd variances = covariance.diagonal().array().max(0.0) + kLeastVariance;
  covariance *= count / (count + 4.0 * size);
  covariance.diagonal() = variances;
  const Eigen::MatrixXd one = Eigen::MatrixXd::Identity(sum_.size(), sum_.size());
  return {centre, covariance.llt().solve(one)};
}

}  // namespace haptrial::analysis::hierarchical
