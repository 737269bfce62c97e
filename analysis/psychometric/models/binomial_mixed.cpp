#include "analysis/psychometric/models/binomial_mixed.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <set>
#include <stdexcept>

#include "analysis/statistics/base/decomposition.h"
#include "analysis/statistics/base/distributions.h"

namespace haptrial::analysis {
namespace {

/// The rows of one participant.
struct BinomialGroup {
  BinomialData data;       // predictors are not used
  Eigen::MatrixXd fixed;   // (rows x p)
  Eigen::MatrixXd random;  // (rows x q)
};

/// The most probable u ~ N(0, I) of a participant, b = lower u.
struct LaplaceMode {
  double log_likelihood{0.0};  // Laplace's, without binomial coefficients
  Eigen::VectorXd u;           // (q)
  Eigen::VectorXd weight;      // (rows) Fisher's information about eta
  Eigen::MatrixXd factor;      // (q x q) L of L L' = I + lower' random' W random lower
};

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// Penalised scoring. Nothing where it does not end.
std::optional<LaplaceMode> laplace_mode(const BinomialGroup& group, BinomialLink link,
                                        const VectorXd& beta, const MatrixXd& lower) {
  constexpr int kMost = 100, kHalvings = 40;
  const MatrixXd z = group.random * lower;
  const VectorXd around = group.fixed * beta;
  LaplaceMode mode;
  mode.u = VectorXd::Zero(lower.cols());
  BinomialRows rows = binomial_rows(group.data, link, around);
  double value = rows.log_likelihood;
  for (int step = 0; step < kMost && std::isfinite(value); ++step) {
    const VectorXd slope = z.transpose() * rows.slope - mode.u;
    const MatrixXd information = z.transpose() * rows.weight.asDiagonal() * z +
                                 MatrixXd::Identity(lower.cols(), lower.cols());
    const auto factor = cholesky(information);
    if (!factor) {
      return std::nullopt;
    }
    const VectorXd half = solve_lower(*factor, slope);
    if (half.squaredNorm() < 1e-26 * (1.0 + std::abs(value))) {
      mode.log_likelihood = value - factor->diagonal().array().log().sum();
      mode.weight = rows.weight;
      mode.factor = *factor;
      return mode;
    }
    const VectorXd change =
        solve_lower(factor->transpose().rowwise().reverse().colwise().reverse(), half.reverse())
            .reverse();
    double part = 1.0;
    bool moved = false;
    for (int i = 0; i < kHalvings && !moved; ++i, part *= 0.5) {
      const VectorXd next = mode.u + part * change;
      const BinomialRows there = binomial_rows(group.data, link, around + z * next);
      const double found = there.log_likelihood - 0.5 * next.squaredNorm();
      moved = found >= value - 1e-13 * std::abs(value);
      if (moved) {
        mode.u = next;
        rows = there;
        value = found;
      }
    }
    if (!moved) {
      return std::nullopt;
    }
  }
  return std::nullopt;
}

/// A lower triangle from its elements, by columns.
MatrixXd lower_triangle(const VectorXd& elements, Index size) {
  MatrixXd lower = MatrixXd::Zero(size, size);
  Index k = 0;
  for (Index column = 0; column < size; ++column) {
    for (Index row = column; row < size; ++row) {
      lower(row, column) = elements[k++];
    }
  }
  return lower;
}

/// The likelihood as a function of the elements of the lower triangle and the coefficients.
class Marginalised {
 public:
  Marginalised(std::vector<BinomialGroup> groups, BinomialLink link)
      : groups_(std::move(groups)),
        link_(link),
        fixed_(groups_.front().fixed.cols()),
        random_(groups_.front().random.cols()) {}

  Index elements() const { return random_ * (random_ + 1) / 2; }
  Index size() const { return elements() + fixed_; }
  VectorXd beta(const VectorXd& p) const { return p.tail(fixed_); }
  MatrixXd lower(const VectorXd& p) const { return lower_triangle(p.head(elements()), random_); }
  const std::vector<BinomialGroup>& groups() const { return groups_; }

  std::optional<LaplaceMode> mode(const BinomialGroup& group, const VectorXd& p) const {
    return laplace_mode(group, link_, beta(p), lower(p));
  }

  /// Minus the logarithm; infinite where it cannot be computed.
  double operator()(const VectorXd& p) const {
    double sum = 0.0;
    for (const BinomialGroup& group : groups_) {
      const auto found = mode(group, p);
      if (!found) {
        return std::numeric_limits<double>::infinity();
      }
      sum -= found->log_likelihood;
    }
    return sum;
  }

 private:
  std::vector<BinomialGroup> groups_;
  BinomialLink link_;
  Index fixed_, random_;
};

/// Slope and Hessian by central differences.
struct Curved {
  VectorXd slope;
  MatrixXd hessian;
};

Curved curved(const Marginalised& f, const VectorXd& p, double value) {
  constexpr double kStep = 1e-4;  // columns have unit length
  const Index n = p.size();
  Curved c{VectorXd(n), MatrixXd(n, n)};
  VectorXd up(n), down(n);
  const auto at = [&](Index i, double a, Index j, double b) {
    VectorXd there = p;
    there[i] += a * kStep;
    there[j] += b * kStep;
    return f(there);
  };
  for (Index i = 0; i < n; ++i) {
    up[i] = at(i, 1.0, i, 0.0);
    down[i] = at(i, -1.0, i, 0.0);
    c.slope[i] = (up[i] - down[i]) / (2.0 * kStep);
    c.hessian(i, i) = (up[i] - 2.0 * value + down[i]) / (kStep * kStep);
    for (Index j = 0; j < i; ++j) {
      const double both = at(i, 1.0, j, 1.0) + at(i, -1.0, j, -1.0);
      c.hessian(i, j) = c.hessian(j, i) =
          (both - up[i] - down[i] - up[j] - down[j] + 2.0 * value) / (2.0 * kStep * kStep);
    }
  }
  return c;
}

struct Lowest {
  VectorXd at;
  double value;
};

/// Newton's method, damped where the function is not convex or a step leads up (Levenberg).
std::optional<Lowest> descended(const Marginalised& f, VectorXd p) {
  constexpr int kMost = 100;
  constexpr double kDone = 1e-10, kNear = 1e-6, kLeastDamping = 1e-9;
  double value = f(p), damping = 1e-3, promise = 0.0;
  if (!std::isfinite(value)) {
    return std::nullopt;
  }
  for (int step = 0; step < kMost; ++step) {
    const Curved c = curved(f, p, value);
    if (!c.slope.allFinite() || !c.hessian.allFinite()) {
      return std::nullopt;
    }
    const double scale = std::max(1.0, c.hessian.diagonal().cwiseAbs().maxCoeff());
    bool moved = false;
    // Newton's own step, without damping, may fail too: from 0 it rises again.
    for (; !moved && damping < 1e6;
         damping = moved ? damping : std::max(10.0 * damping, kLeastDamping)) {
      const auto change = solve_positive(
          c.hessian + damping * 1e-3 * scale * MatrixXd::Identity(p.size(), p.size()), -c.slope);
      if (!change) {
        continue;
      }
      promise = -0.5 * change->col(0).dot(c.slope);
      const VectorXd next = p + change->col(0);
      const double there = f(next);
      moved = there < value || (promise < kDone && there <= value + 1e-12 * std::abs(value));
      if (moved) {
        p = next;
        value = there;
      }
    }
    if (!moved || promise < kDone) {
      break;
    }
    damping = damping < 1e-12 ? 0.0 : damping * 0.01;
  }
  // Towards a singular covariance the last steps are many and small.
  return promise < kNear ? std::optional(Lowest{p, value}) : std::nullopt;
}

std::vector<BinomialGroup> grouped(const BinomialData& data, const MatrixXd& columns,
                                   std::span<const std::size_t> participants,
                                   std::span<const std::size_t> random) {
  std::map<std::size_t, std::vector<Index>> rows;
  for (std::size_t i = 0; i < participants.size(); ++i) {
    rows[participants[i]].push_back(static_cast<Index>(i));
  }
  const std::vector<Index> chosen(random.begin(), random.end());
  std::vector<BinomialGroup> groups;
  for (const auto& [participant, own] : rows) {
    BinomialGroup& group = groups.emplace_back();
    group.fixed = columns(own, Eigen::all);
    group.random = group.fixed(Eigen::all, chosen);
    for (const Index row : own) {
      group.data.yes.push_back(data.yes[static_cast<std::size_t>(row)]);
      group.data.trials.push_back(data.trials[static_cast<std::size_t>(row)]);
    }
  }
  return groups;
}

void check_random(const BinomialData& data, std::span<const std::size_t> participants,
                  std::span<const std::size_t> random) {
  if (participants.size() != data.yes.size()) {
    throw std::invalid_argument("participants must have a number for each row");
  }
  const std::set<std::size_t> different(random.begin(), random.end());
  if (random.empty() || different.size() != random.size() ||
      *different.rbegin() > static_cast<std::size_t>(data.predictors.cols())) {
    throw std::invalid_argument(
        "random must name different columns: 0 the intercept, k predictor k");
  }
}

/// The lowest of searches that begin with small and with large random effects.
std::optional<Lowest> lowest_of(const Marginalised& f, const VectorXd& beta, Index random) {
  std::optional<Lowest> best;
  for (const double deviation : {0.2, 0.8}) {
    VectorXd start = VectorXd::Zero(f.size());
    start.tail(beta.size()) = beta;
    for (Index column = 0, k = 0; column < random; k += random - column, ++column) {
      start[k] = deviation;
    }
    const auto found = descended(f, start);
    if (found && (!best || found->value < best->value)) {
      best = found;
    }
  }
  return best;
}

/// Information about the coefficients: X' V^-1 X of the linear model around the modes.
MatrixXd information_of(const Marginalised& f, const VectorXd& p, MatrixXd& effects) {
  const MatrixXd lower = f.lower(p);
  MatrixXd information = MatrixXd::Zero(f.beta(p).size(), f.beta(p).size());
  effects.resize(std::ssize(f.groups()), lower.rows());
  Index g = 0;
  for (const BinomialGroup& group : f.groups()) {
    const auto mode = f.mode(group, p);
    const MatrixXd weighted = mode->weight.asDiagonal() * group.fixed;
    const MatrixXd half = solve_lower(mode->factor, (group.random * lower).transpose() * weighted);
    information += group.fixed.transpose() * weighted - half.transpose() * half;
    effects.row(g++) = (lower * mode->u).transpose();
  }
  return information;
}

}  // namespace

Defined<BinomialMixedModel> binomial_mixed_model(const BinomialData& data, BinomialLink link,
                                                 std::span<const std::size_t> participants,
                                                 std::span<const std::size_t> random,
                                                 double level) {
  const MatrixXd raw = checked_columns(data);
  check_random(data, participants, random);
  const auto pooled = binomial_regression(data, link, level);
  if (!pooled) {
    return Undefined{pooled.because()};
  }
  BinomialMixedModel model;
  const std::set<std::size_t> people(participants.begin(), participants.end());
  model.participants.assign(people.begin(), people.end());
  if (people.size() < 2) {
    return Undefined{"there is only one participant"};
  }
  const VectorXd scale = raw.colwise().norm().transpose() / std::sqrt(double(raw.rows()));
  const MatrixXd columns = raw * scale.cwiseInverse().asDiagonal();
  const Marginalised f(grouped(data, columns, participants, random), link);
  VectorXd beta(raw.cols());
  for (Index k = 0; k < beta.size(); ++k) {
    beta[k] = pooled->coefficients[static_cast<std::size_t>(k)].estimate * scale[k];
  }
  const Index effects = std::ssize(random);
  const auto best = lowest_of(f, beta, effects);
  if (!best) {
    return Undefined{"the search for the largest likelihood does not end"};
  }
  const MatrixXd information = information_of(f, best->at, model.effects);
  const auto inverse = solve_positive(information, MatrixXd::Identity(beta.size(), beta.size()));
  if (!inverse) {
    return Undefined{"the coefficients have no covariance"};
  }
  VectorXd back(effects);
  for (Index k = 0; k < effects; ++k) {
    back[k] = 1.0 / scale[static_cast<Index>(random[static_cast<std::size_t>(k)])];
  }
  const MatrixXd lower = f.lower(best->at);
  model.random_covariance = back.asDiagonal() * lower * lower.transpose() * back.asDiagonal();
  model.effects = model.effects * back.asDiagonal();
  model.at_boundary = lower.diagonal().cwiseAbs().minCoeff() < 1e-4;  // lme4's measure
  model.parameters = static_cast<int>(f.size());
  model.fixed.level = level;
  model.fixed.observations = data.yes.size();
  model.fixed.covariance =
      scale.cwiseInverse().asDiagonal() * *inverse * scale.cwiseInverse().asDiagonal();
  model.fixed.log_likelihood = log_binomials(data) - best->value;
  model.fixed.deviance = 2.0 * (log_likelihood_of_shares(data) + best->value);
  add_normal_tests(model.fixed, f.beta(best->at).cwiseQuotient(scale));
  return model;
}

}  // namespace haptrial::analysis
