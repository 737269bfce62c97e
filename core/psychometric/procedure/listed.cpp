#include "core/psychometric/procedure/listed.h"

#include <algorithm>
#include <cmath>

namespace haptrial::psychometric {
namespace {

constexpr const char* kConstant = "ConstantStimuli";
constexpr const char* kMagnitude = "MagnitudeEstimation";

/// Sums about the means of both.
struct Products {
  double mean_x{0.0}, mean_y{0.0};
  double xx{0.0}, xy{0.0}, yy{0.0};
};

Products products(const std::vector<double>& x, const std::vector<double>& y) {
  Products p;
  const auto n = static_cast<double>(x.size());
  for (std::size_t i = 0; i < x.size(); ++i) {
    p.mean_x += x[i] / n;
    p.mean_y += y[i] / n;
  }
  for (std::size_t i = 0; i < x.size(); ++i) {
    const double dx = x[i] - p.mean_x;
    const double dy = y[i] - p.mean_y;
    p.xx += dx * dx;
    p.xy += dx * dy;
    p.yy += dy * dy;
  }
  return p;
}

}  // namespace

ListedLevels::ListedLevels(const std::vector<double>& order, const char* who) : who_(who) {
  order_.reserve(order.size());
  for (double level : order) {
    order_.push_back({level});
  }
}

const Level& ListedLevels::next() const {
  checks::require_running(!finished(), who_);
  return order_[outcomes_.size()];
}

void ListedLevels::report(double answer, const Level& applied) {
  checks::require_running(!finished(), who_);
  checks::single_level(applied, who_);
  check(answer);
  outcomes_.push_back({answer, applied});
}

void ListedLevels::postpone() {
  checks::require_running(!finished(), who_);
  const auto present = order_.begin() + static_cast<std::ptrdiff_t>(outcomes_.size());
  std::rotate(present, present + 1, order_.end());
}

ConstantStimuli::ConstantStimuli(const ListParameters& list, std::uint64_t seed,
                                 std::string_view name, std::size_t outcomes)
    : ListedLevels(shuffled(list, seed, name, kConstant), kConstant),
      number_of_outcomes_(outcomes) {
  checks::require(outcomes >= 2, kConstant, "outcomes must be at least 2");
}

void ConstantStimuli::check(double answer) const {
  checks::outcome_of(answer, number_of_outcomes_, kConstant);
}

MagnitudeEstimation::MagnitudeEstimation(const ListParameters& list, std::optional<double> modulus,
                                         std::uint64_t seed, std::string_view name)
    : ListedLevels(shuffled(list, seed, name, kMagnitude), kMagnitude), modulus_(modulus) {
  checks::require(*std::min_element(list.levels.begin(), list.levels.end()) > 0.0, kMagnitude,
                  "levels must be above 0");
  checks::require(!modulus || (*modulus > 0.0 && std::isfinite(*modulus)), kMagnitude,
                  "modulus must be finite and above 0");
}

void MagnitudeEstimation::check(double answer) const {
  checks::require(answer > 0.0 && std::isfinite(answer), kMagnitude,
                  "answer must be finite and above 0");
}

std::vector<Estimate> MagnitudeEstimation::estimates() const {
  std::vector<double> levels;
  std::vector<double> answers;
  for (const Outcome& outcome : outcomes()) {
    if (outcome.applied[0] > 0.0) {
      levels.push_back(std::log(outcome.applied[0]));
      answers.push_back(std::log(outcome.answer));
    }
  }
  const Products p = products(levels, answers);
  if (!(p.xx > 0.0)) {
    return {};
  }
  Estimate estimate{"exponent of the power law", p.xy / p.xx, {}};
  if (levels.size() > 2) {
    const double residual = std::max(0.0, p.yy - p.xy * p.xy / p.xx);
    estimate.freedom = static_cast<double>(levels.size() - 2);
    estimate.deviation = std::sqrt(residual / *estimate.freedom / p.xx);
  }
  return {estimate};
}

}  // namespace haptrial::psychometric
