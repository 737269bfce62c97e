#include "core/psychometric/procedure/limits.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/base/random.h"
#include "core/psychometric/procedure/both_sides.h"

namespace haptrial::psychometric {
namespace {

constexpr const char* kLimits = "Limits";
constexpr double kRounding = 1e-9;  // of a step: sums of steps end beside the range's end

}  // namespace

Limits::Limits(const LimitsParameters& parameters, std::uint64_t seed, std::string_view name)
    : parameters_(parameters), seed_(seed), name_(name) {
  const LimitsParameters& p = parameters_;
  checks::require(p.low < p.high && std::isfinite(p.axis.at(p.low)), kLimits,
                  "low must be below high, and both on the axis");
  checks::require(p.step > 0.0 && p.axis.at(p.high) - p.axis.at(p.low) >= p.step, kLimits,
                  "step must be above 0 and at most the range");
  checks::require(p.series >= 1, kLimits, "series must be 1 or more");
  checks::require(p.start_steps >= 0 &&
                      p.start_steps * p.step <= 0.5 * (p.axis.at(p.high) - p.axis.at(p.low)),
                  kLimits, "start_steps must be 0 or more, and reach half of the range at most");
  begin();
}

int Limits::longest_series(const LimitsParameters& p) {
  const double steps = (p.axis.at(p.high) - p.axis.at(p.low)) / p.step;
  return static_cast<int>(std::floor(steps + kRounding)) + 1;
}

void Limits::begin() {
  before_.reset();
  RandomStream random(seed_, fmt::format("{} series {}", name_, done_));
  const auto choices = static_cast<std::uint64_t>(parameters_.start_steps) + 1;
  const double within = parameters_.step * static_cast<double>(random.below(choices));
  const Axis& axis = parameters_.axis;
  next_ = {axis.level(descends() ? axis.at(parameters_.high) - within
                                 : axis.at(parameters_.low) + within)};
}

const Level& Limits::next() const {
  checks::require_running(!finished(), kLimits);
  return next_;
}

void Limits::end_series(std::optional<double> threshold) {
  if (threshold) {
    (descends() ? descending_ : ascending_).push_back(*threshold);
  } else {
    ++without_;
  }
  ++done_;
  if (!finished()) {
    begin();
  }
}

void Limits::report(double answer, const Level& applied) {
  checks::require_running(!finished(), kLimits);
  const double x = parameters_.axis.at(checks::single_level(applied, kLimits));
  const bool felt = checks::outcome_of(answer, 2, kLimits) == 1;
  if (felt != descends()) {
    end_series(before_ ? std::optional(0.5 * (*before_ + x)) : std::nullopt);
    return;
  }
  before_ = x;
  const Axis& axis = parameters_.axis;
  const double step = parameters_.step;
  const double following = x + (descends() ? -step : step);
  const bool beyond = following < axis.at(parameters_.low) - kRounding * step ||
                      following > axis.at(parameters_.high) + kRounding * step;
  if (beyond) {
    end_series(std::nullopt);
  } else {
    next_ = {std::clamp(axis.level(following), parameters_.low, parameters_.high)};
  }
}

std::vector<Estimate> Limits::estimates() const {
  if (descending_.empty() && ascending_.empty()) {
    return {};
  }
  const std::size_t count = descending_.size() + ascending_.size();
  Estimate estimate = mean_of_sides(ascending_, descending_);
  estimate.name = fmt::format("threshold, mean of {} series", count);
  estimate.value = parameters_.axis.level(estimate.value);
  if (estimate.deviation) {
    *estimate.deviation /= parameters_.axis.gradient(estimate.value);
  }
  if (without_ > 0) {
    estimate.remark =
        fmt::format("{} of {} series had no change of the answer within the range", without_,
                    done_);
  }
  return {estimate};
}

}  // namespace haptrial::psychometric
