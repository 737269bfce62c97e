#include "core/psychometric/procedure/smooth_function.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "core/psychometric/function/sigmoid.h"
#include "core/psychometric/procedure/procedure.h"

namespace haptrial::psychometric {
namespace {

constexpr double kHalfBox =
    1.5;  // the sines are zero there; beyond the cube, where nothing is seen
constexpr std::array<std::size_t, 4> kSines{12, 44, 100, 150};
constexpr int kMostWaves = 12;

double frequency(int half_waves) { return half_waves * std::numbers::pi / (2.0 * kHalfBox); }

double squared_frequency(const std::vector<int>& waves) {
  double sum = 0.0;
  for (const int each : waves) {
    sum += frequency(each) * frequency(each);
  }
  return sum;
}

/// The slowest sines over `dimensions` variables.
std::vector<std::vector<int>> slowest(std::size_t dimensions) {
  std::vector<std::vector<int>> all{{}};
  for (std::size_t k = 0; k < dimensions; ++k) {
    std::vector<std::vector<int>> longer;
    for (const auto& each : all) {
      for (int waves = 1; waves <= kMostWaves; ++waves) {
        longer.push_back(each);
        longer.back().push_back(waves);
      }
    }
    all = std::move(longer);
  }
  std::stable_sort(all.begin(), all.end(), [](const auto& a, const auto& b) {
    return squared_frequency(a) < squared_frequency(b);
  });
  all.resize(std::min(all.size(), kSines[dimensions - 1]));
  return all;
}

}  // namespace

ProbitChange change_by(const ProbitLink& link, double m, double v) noexcept {
  const double spread = std::sqrt(1.0 + v);
  const double z = link.sign * m / spread;
  const double probability = link.floor + link.share * sigmoid(Sigmoid::kGaussian, z);
  const double density = sigmoid_density(Sigmoid::kGaussian, z);
  if (!(probability > 0.0)) {
    return {0.0, 0.0, 0.0};
  }
  // First and second derivative of the logarithm of the probability by m.
  const double pull = link.share * link.sign * density / (spread * probability);
  const double bend = pull * pull + link.share * z * density / (spread * spread * probability);
  return {probability, pull, std::max(0.0, bend)};
}

SmoothBasis::SmoothBasis(std::size_t dimensions) : dimensions_(dimensions) {
  checks::require(dimensions >= 1 && dimensions <= kSines.size(), "SmoothBasis",
                  "dimensions must be 1 to 4");
  waves_ = slowest(dimensions);
}

Eigen::Index SmoothBasis::size() const noexcept {
  return static_cast<Eigen::Index>(1 + dimensions_ + waves_.size());
}

Eigen::VectorXd SmoothBasis::at(const std::vector<double>& u) const {
  Eigen::VectorXd row(size());
  Eigen::Index i = 0;
  row[i++] = 1.0;
  for (std::size_t k = 0; k < dimensions_; ++k) {
    row[i++] = std::clamp(u[k], -1.0, 1.0);
  }
  for (const auto& waves : waves_) {
    double product = 1.0;
    for (std::size_t k = 0; k < dimensions_; ++k) {
      const double x = std::clamp(u[k], -1.0, 1.0) + kHalfBox;
      product *= std::sin(frequency(waves[k]) * x) / std::sqrt(kHalfBox);
    }
    row[i++] = product;
  }
  return row;
}

Eigen::VectorXd SmoothBasis::slope(const std::vector<double>& u, std::size_t k) const {
  Eigen::VectorXd row = Eigen::VectorXd::Zero(size());
  row[1 + static_cast<Eigen::Index>(k)] = 1.0;
  Eigen::Index i = 1 + static_cast<Eigen::Index>(dimensions_);
  for (const auto& waves : waves_) {
    double product = frequency(waves[k]);
    for (std::size_t j = 0; j < dimensions_; ++j) {
      const double phase = frequency(waves[j]) * (u[j] + kHalfBox);
      product *= (j == k ? std::cos(phase) : std::sin(phase)) / std::sqrt(kHalfBox);
    }
    row[i++] = product;
  }
  return row;
}

Eigen::VectorXd SmoothBasis::deviations(const Smoothness& p) const {
  Eigen::VectorXd deviations = Eigen::VectorXd::Constant(size(), p.slope);
  const double height = std::pow(std::sqrt(2.0 * std::numbers::pi) * p.length,
                                 0.5 * static_cast<double>(dimensions_));
  Eigen::Index i = 1 + static_cast<Eigen::Index>(dimensions_);
  for (const auto& waves : waves_) {
    deviations[i++] = p.slope * p.bend * height *
                      std::exp(-0.25 * p.length * p.length * squared_frequency(waves));
  }
  return deviations;
}

SmoothBelief::SmoothBelief(const Eigen::VectorXd& deviations)
    : mean_(Eigen::VectorXd::Zero(deviations.size())),
      covariance_(deviations.cwiseAbs2().asDiagonal()) {}

SmoothBelief::Visit SmoothBelief::visit(std::size_t fact, const Eigen::VectorXd& row,
                                        const ProbitLink& link) {
  facts_.resize(std::max(facts_.size(), fact + 1));
  NormalFactor& old = facts_[fact];
  const Eigen::VectorXd reach = covariance_ * row;
  const double variance = row.dot(reach);
  const double without = 1.0 - old.precision * variance;
  constexpr double kLeast = 1e-9;
  if (!(variance > 0.0) || without < kLeast) {
    return {};
  }
  // Mean and variance along the row without this fact.
  const double v = variance / without;
  const double m = (row.dot(mean_) - variance * old.shift) / without;
  const auto [probability, pull, bend] = change_by(link, m, v);
  if (!(probability > 0.0)) {
    return {};
  }
  const double rest = 1.0 - bend * v;
  if (rest < kLeast) {
    return {probability};
  }
  const NormalFactor now{bend / rest, (pull + m * bend) / rest};
  const double added = now.precision - old.precision;
  const double grown = 1.0 + added * variance;
  if (grown < kLeast) {
    return {probability};
  }
  mean_ += reach * ((now.shift - old.shift - added * row.dot(mean_)) / grown);
  covariance_.noalias() -= (added / grown) * reach * reach.transpose();
  old = now;
  return {probability, added * grown};
}

}  // namespace haptrial::psychometric
