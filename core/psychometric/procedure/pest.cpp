#include "core/psychometric/procedure/pest.h"

#include <algorithm>
#include <cmath>

namespace haptrial::psychometric {
namespace {

constexpr const char* kPest = "Pest";

void check_pest(const PestParameters& p) {
  const auto require = [](bool holds, const char* sentence) {
    checks::require(holds, kPest, sentence);
  };
  require(std::isfinite(p.axis.at(p.low)),
          "low must be finite, and above the origin of a logarithmic scale");
  require(std::isfinite(p.high) && p.low < p.high, "high must be finite and above low");
  require(p.start >= p.low && p.start <= p.high, "start must be from low to high");
  require(p.target > 0.0 && p.target < 1.0, "target must be between 0 and 1");
  require(p.deviation > 0.0 && std::isfinite(p.deviation), "deviation must be finite and above 0");
  require(p.smallest_step > 0.0, "smallest_step must be above 0");
  require(p.first_step > p.smallest_step && p.first_step <= p.largest_step,
          "first_step must be above smallest_step and at most largest_step");
  require(std::isfinite(p.largest_step), "largest_step must be finite");
  require(p.stop_trials >= 1 && p.stop_trials <= 1'000'000,
          "stop_trials must be from 1 to 1000000");
}

}  // namespace

Pest::Pest(const PestParameters& parameters)
    : parameters_(parameters), size_(parameters.first_step) {
  check_pest(parameters_);
  x_ = parameters_.axis.at(parameters_.start);
  next_ = {parameters_.start};
}

const Level& Pest::next() const {
  checks::require_running(!finished(), kPest);
  return next_;
}

void Pest::report(double answer, const Level& applied) {
  checks::require_running(!finished(), kPest);
  const bool right = checks::outcome_of(answer, 2, kPest) == 1;
  const double x = parameters_.axis.at(checks::single_level(applied, kPest));
  checks::require(std::isfinite(x), kPest,
                  "applied must be above the origin of a logarithmic scale");
  if (applied[0] != next_[0]) {
    x_ = x;
  }
  ++trials_;
  ++trials_here_;
  right_here_ += right;
  const double excess = right_here_ - parameters_.target * trials_here_;
  if (excess >= parameters_.deviation) {
    step(-1);
  } else if (excess <= -parameters_.deviation) {
    step(1);
  }
}

void Pest::step(int way) {
  bool doubles = false;
  if (direction_ != 0 && way != direction_) {
    doubled_before_reversal_ = doubled_;
    in_direction_ = 1;
    size_ *= 0.5;
  } else {
    ++in_direction_;
    doubles = in_direction_ >= 4 || (in_direction_ == 3 && !doubled_before_reversal_);
    size_ = std::min(doubles ? 2.0 * size_ : size_, parameters_.largest_step);
  }
  doubled_ = doubles;
  direction_ = way;
  converged_ = size_ <= parameters_.smallest_step;
  const double move = parameters_.right_raises ? -way * size_ : way * size_;
  x_ = std::clamp(x_ + move, parameters_.axis.at(parameters_.low),
                  parameters_.axis.at(parameters_.high));
  next_[0] = std::clamp(parameters_.axis.level(x_), parameters_.low, parameters_.high);
  trials_here_ = 0;
  right_here_ = 0;
}

std::vector<Estimate> Pest::estimates() const {
  if (!converged_) {
    return {};
  }
  return {{"level that PEST settled on", next_[0], std::nullopt}};
}

}  // namespace haptrial::psychometric
