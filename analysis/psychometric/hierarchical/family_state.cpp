#include "analysis/psychometric/hierarchical/family_state.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <limits>

namespace haptrial::analysis::hierarchical {
namespace {

constexpr double kSmallestShare = 1e-5;  // of a spread, of the scale of its prior
constexpr double kDegrees = 3.0;         // of the half-t

/// Standard deviation of a person's mean over k conditions.
double mean_deviation(const Family& family, const FamilyState& state, double k) noexcept {
  return family.within ? std::sqrt(state.between * state.between + state.within * state.within / k)
                       : state.between;
}

double entry_count(const Family& family, std::size_t person) noexcept {
  return static_cast<double>(family.first[person + 1] - family.first[person]);
}

/// Distances of one person's values from the means of the group: their mean over the conditions,
/// and the squares of what differs from it.
struct PersonDistance {
  double mean{0.0}, squares{0.0}, count{1.0};
};

std::vector<PersonDistance> distances_of(const Family& family, const FamilyState& state) {
  std::vector<PersonDistance> all;
  for (std::size_t person = 0; person + 1 < family.first.size(); ++person) {
    PersonDistance& made = all.emplace_back();
    made.count = entry_count(family, person);
    double squares = 0.0;
    for (std::size_t e = family.first[person]; e < family.first[person + 1]; ++e) {
      const double distance = state.values[e] - state.means[family.column[e]];
      made.mean += distance / made.count;
      squares += distance * distance;
    }
    made.squares = std::max(0.0, squares - made.count * made.mean * made.mean);
  }
  return all;
}

/// Log-density of the values given the spreads, up to a constant.
double log_density(const Family& family, const FamilyState& state,
                   const std::vector<PersonDistance>& all) noexcept {
  double sum = 0.0;
  for (const PersonDistance& each : all) {
    const double deviation = mean_deviation(family, state, each.count);
    sum -= std::log(deviation) + 0.5 * each.mean * each.mean / (deviation * deviation);
    if (family.within) {
      sum -= (each.count - 1.0) * std::log(state.within) +
             0.5 * each.squares / (state.within * state.within);
    }
  }
  return sum;
}

/// Draws one spread by a slice over its logarithm, one unit wide at first.
void draw_spread(const Family& family, FamilyState& state, double FamilyState::*spread,
                 const std::vector<PersonDistance>& all, RandomStream& random) {
  const double least = std::log(kSmallestShare * family.prior.spread);
  const auto density = [&](double logarithm) {
    if (logarithm < least) {
      return -std::numeric_limits<double>::infinity();
    }
    state.*spread = std::exp(logarithm);
    return log_density(family, state, all) + log_spread_prior(family.prior, state.*spread);
  };
  const double here = std::log(state.*spread);
  const double height = density(here) + std::log(1.0 - random.uniform());
  double low = here - random.uniform(), high = low + 1.0;
  while (density(low) > height) {
    low -= 1.0;
  }
  while (density(high) > height) {
    high += 1.0;
  }
  for (double next = random.uniform(low, high); density(next) <= height && high - low > 1e-12;
       next = random.uniform(low, high)) {
    (next < here ? low : high) = next;
  }
}

}  // namespace

double log_spread_prior(const FamilyPrior& prior, double spread) noexcept {
  const double t = spread / prior.spread;
  return std::log(spread) - 0.5 * (kDegrees + 1.0) * std::log1p(t * t / kDegrees);
}

EntryPrecision entry_precision(const Family& family, const FamilyState& state,
                               std::size_t entries) noexcept {
  const double between = state.between * state.between;
  if (!family.within) {
    return {1.0 / between, 0.0};
  }
  const double within = state.within * state.within;
  return {1.0 / within, between / (within * (within + static_cast<double>(entries) * between))};
}

void draw_means(const Family& family, FamilyState& state, RandomStream& random) {
  const auto columns = static_cast<Eigen::Index>(family.columns);
  const double prior = 1.0 / (family.prior.deviation * family.prior.deviation);
  Eigen::MatrixXd precision = Eigen::MatrixXd::Identity(columns, columns) * prior;
  Eigen::VectorXd pull = Eigen::VectorXd::Constant(columns, prior * family.prior.mean);
  for (std::size_t person = 0; person + 1 < family.first.size(); ++person) {
    const std::size_t first = family.first[person], end = family.first[person + 1];
    const EntryPrecision own = entry_precision(family, state, end - first);
    for (std::size_t a = first; a < end; ++a) {
      const auto row = static_cast<Eigen::Index>(family.column[a]);
      for (std::size_t b = first; b < end; ++b) {
        const double weight = (a == b ? own.diagonal : 0.0) - own.shared;
        precision(row, static_cast<Eigen::Index>(family.column[b])) += weight;
        pull[row] += weight * state.values[b];
      }
    }
  }
  const Eigen::LLT<Eigen::MatrixXd> factor(precision);
  Eigen::VectorXd noise(columns);
  for (Eigen::Index i = 0; i < columns; ++i) {
    noise[i] = random.normal();
  }
  const Eigen::VectorXd drawn = factor.solve(pull) + factor.matrixU().solve(noise);
  state.means.assign(drawn.begin(), drawn.end());
}

void draw_spreads(const Family& family, FamilyState& state, RandomStream& random) {
  const std::vector<PersonDistance> all = distances_of(family, state);
  draw_spread(family, state, &FamilyState::between, all, random);
  if (family.within) {
    draw_spread(family, state, &FamilyState::within, all, random);
  }
}

}  // namespace haptrial::analysis::hierarchical
