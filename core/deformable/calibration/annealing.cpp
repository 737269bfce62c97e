#include "core/deformable/calibration/annealing.h"

#include <algorithm>
#include <cmath>

#include "core/base/require.h"

namespace haptrial::deformable {
namespace {

const AnnealingOptions& checked_options(const AnnealingOptions& o) {
  require(o.samples >= 1 && o.batch >= 1, "samples and batch must be 1 or more");
  require(o.ratio > 0.0 && o.ratio < 1.0, "ratio must lie inside (0, 1)");
  require(o.scale > 1.0, "scale must be above 1");
  require(o.accepted_until >= 1, "accepted_until must be 1 or more");
  require(o.probe > 0.0 && o.probe < 0.5, "probe must lie inside (0, 0.5)");
  return o;
}

/// T after k steps, and its inverse.
struct Cooling {
  double rate, power;

  Cooling(const AnnealingOptions& options, std::size_t dimensions)
      : rate(-std::log(options.ratio) *
             std::exp(-std::log(options.scale) / static_cast<double>(dimensions))),
        power(1.0 / static_cast<double>(dimensions)) {}
  double temperature(double steps) const { return std::exp(-rate * std::pow(steps, power)); }
  double steps(double temperature) const {
    return std::pow(std::max(0.0, -std::log(temperature)) / rate, 1.0 / power);
  }
};

}  // namespace

Annealing::Annealing(std::vector<SearchRange> ranges, std::uint64_t seed,
                     const AnnealingOptions& options)
    : ranges_(std::move(ranges)),
      options_(checked_options(options)),
      random_(seed, "annealing"),
      steps_(ranges_.size(), 0.0) {
  require(!ranges_.empty(), "there must be a range");
  for (const SearchRange& range : ranges_) {
    require(std::isfinite(range.low) && std::isfinite(range.high) && range.low < range.high,
            "a range must be finite and not empty");
  }
}

double Annealing::temperature(std::size_t i) const {
  return Cooling(options_, ranges_.size()).temperature(steps_[i]);
}

std::vector<double> Annealing::sample() {
  std::vector<double> point;
  for (const SearchRange& range : ranges_) {
    point.push_back(random_.uniform(range.low, range.high));
  }
  return point;
}

std::vector<double> Annealing::candidate() {
  std::vector<double> point = current_;
  for (std::size_t i = 0; i < point.size(); ++i) {
    const double t = temperature(i), width = ranges_[i].high - ranges_[i].low;
    do {
      const double u = random_.uniform();
      const double y = t * std::expm1(std::abs(2.0 * u - 1.0) * std::log1p(1.0 / t));
      point[i] = current_[i] + std::copysign(y, u - 0.5) * width;
    } while (!(point[i] >= ranges_[i].low && point[i] <= ranges_[i].high));
  }
  return point;
}

/// The best point, a little along one axis, to the side where there is room.
std::vector<double> Annealing::probe_point(std::size_t i) const {
  std::vector<double> point = best_;
  const double step = options_.probe * (ranges_[i].high - ranges_[i].low);
  point[i] += point[i] + step <= ranges_[i].high ? step : -step;
  return point;
}

const std::vector<std::vector<double>>& Annealing::ask() {
  if (!asked_.empty()) {
    return asked_;
  }
  if (phase_ == Phase::kSensitivities) {
    for (std::size_t i = 0; i < ranges_.size(); ++i) {
      asked_.push_back(probe_point(i));
    }
    return asked_;
  }
  const int count = phase_ == Phase::kSamples && evaluations_ == 0 ? options_.samples  //
                                                                   : options_.batch;
  for (int i = 0; i < count; ++i) {
    asked_.push_back(phase_ == Phase::kSamples ? sample() : candidate());
  }
  return asked_;
}

void Annealing::tell(std::span<const double> costs) {
  require(costs.size() == asked_.size() && !costs.empty(),
          "costs must be those of the points that were asked for");
  require(std::none_of(costs.begin(), costs.end(), [](double c) { return std::isnan(c); }),
          "a cost must be a number");
  evaluations_ += static_cast<long>(costs.size());
  const Phase phase = phase_;
  for (std::size_t i = 0; i < costs.size(); ++i) {
    if (phase == Phase::kSearch) {
      judge(asked_[i], costs[i]);
    }
    if (phase != Phase::kSensitivities) {
      keep_best(asked_[i], costs[i]);
    }
  }
  if (phase == Phase::kSamples && std::isfinite(best_cost_)) {
    current_ = best_;
    cost_ = first_cost_temperature_ = best_cost_;
    phase_ = Phase::kSearch;
  }
  if (phase == Phase::kSearch && accepted_ >= options_.accepted_until) {
    phase_ = Phase::kSensitivities;
  }
  if (phase == Phase::kSensitivities) {
    set_temperatures(costs);
    for (std::size_t i = 0; i < costs.size(); ++i) {
      keep_best(asked_[i], costs[i]);
    }
    phase_ = Phase::kSearch;
  }
  asked_.clear();
}

void Annealing::keep_best(const std::vector<double>& point, double cost) {
  if (cost < best_cost_) {
    best_ = point;
    best_cost_ = cost;
  }
}

void Annealing::judge(const std::vector<double>& point, double cost) {
  for (double& steps : steps_) {
    steps += 1.0;
  }
  const double t =
      first_cost_temperature_ * Cooling(options_, ranges_.size()).temperature(cost_steps_);
  const double worse = cost - cost_;
  const double likely = std::isfinite(cost) ? 1.0 / (1.0 + std::exp(worse / t)) : 0.0;
  if (random_.uniform() >= (worse < 0.0 ? 1.0 : likely)) {
    return;
  }
  current_ = point;
  cost_ = cost;
  cost_steps_ += 1.0;
  ++accepted_;
}

void Annealing::set_temperatures(std::span<const double> costs) {
  const Cooling cooling(options_, ranges_.size());
  std::vector<double> sensitivity;
  for (const double cost : costs) {
    sensitivity.push_back(std::isfinite(cost) ? std::abs(cost - best_cost_) : 0.0);
  }
  const double largest = *std::max_element(sensitivity.begin(), sensitivity.end());
  for (std::size_t i = 0; i < steps_.size() && largest > 0.0; ++i) {
    const double wider = largest / std::max(sensitivity[i], 1e-10 * largest);
    steps_[i] = cooling.steps(std::min(1.0, temperature(i) * wider));
  }
  // The acceptance begins anew where the search now is.
  const double t = first_cost_temperature_ * cooling.temperature(cost_steps_);
  first_cost_temperature_ = std::max(cost_, best_cost_);
  cost_steps_ = first_cost_temperature_ > 0.0
                    ? cooling.steps(std::min(1.0, std::max(t / first_cost_temperature_, 1e-300)))
                    : 0.0;
  current_ = best_;
  cost_ = best_cost_;
  accepted_ = 0;
}

}  // namespace haptrial::deformable
