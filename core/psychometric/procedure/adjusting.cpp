#include "core/psychometric/procedure/adjusting.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/psychometric/procedure/both_sides.h"

namespace haptrial::psychometric {
namespace {

constexpr const char* kAdjusting = "Adjusting";

}  // namespace

Adjusting::Adjusting(const AdjustingParameters& parameters, std::uint64_t seed,
                     std::string_view name)
    : parameters_(parameters), starts_(shuffled(parameters.starts, seed, name, kAdjusting)) {
  const AdjustingParameters& p = parameters_;
  const auto good_step = [](double step) { return step > 0.0 && std::isfinite(step); };
  checks::require(!p.steps.empty() && std::all_of(p.steps.begin(), p.steps.end(), good_step),
                  kAdjusting, "steps must be one or more numbers above 0");
  checks::require(p.low < p.high && std::isfinite(p.axis.at(p.low)), kAdjusting,
                  "low must be below high, and both on the axis");
  checks::require(p.most_presentations >= 1, kAdjusting, "most_presentations must be 1 or more");
  for (const double start : starts_) {
    checks::require(start >= p.low && start <= p.high, kAdjusting,
                    "starts must be between low and high");
  }
  begin();
}

void Adjusting::begin() {
  step_ = 0;
  direction_ = presentations_ = 0;
  if (!finished()) {
    level_ = {starts_[at_]};
  }
}

const Level& Adjusting::next() const {
  checks::require_running(!finished(), kAdjusting);
  return level_;
}

void Adjusting::report(double answer, const Level& applied) {
  checks::require_running(!finished(), kAdjusting);
  const double level = checks::single_level(applied, kAdjusting);
  checks::require(answer == -1.0 || answer == 0.0 || answer == 1.0, kAdjusting,
                  "answer must be -1, 0 or 1");
  began_ = presentations_ == 0 ? level : began_;
  ++presentations_;
  if (answer == 0.0) {
    settings_.push_back(level);
    from_above_.push_back(began_ > level);
  }
  if (answer == 0.0 || presentations_ >= parameters_.most_presentations) {
    given_up_ += answer == 0.0 ? 0 : 1;
    ++at_;
    begin();
    return;
  }
  const int direction = answer > 0.0 ? 1 : -1;
  if (direction_ != 0 && direction != direction_) {
    step_ = std::min(step_ + 1, parameters_.steps.size() - 1);
  }
  direction_ = direction;
  const Axis& axis = parameters_.axis;
  const double moved = axis.level(axis.at(level) + direction * parameters_.steps[step_]);
  level_ = {std::clamp(moved, parameters_.low, parameters_.high)};
}

std::vector<Estimate> Adjusting::estimates() const {
  if (settings_.empty()) {
    return {};
  }
  std::vector<double> below, above;
  for (std::size_t i = 0; i < settings_.size(); ++i) {
    (from_above_[i] ? above : below).push_back(settings_[i]);
  }
  Estimate estimate = mean_of_sides(below, above);
  estimate.name = fmt::format("mean of {} settings{}", settings_.size(),
                              sides_count_alike(below, above) ? ", both sides alike" : "");
  if (given_up_ > 0) {
    estimate.remark = fmt::format("{} of {} adjustments ended without a setting", given_up_, at_);
  }
  return {estimate};
}

}  // namespace haptrial::psychometric
