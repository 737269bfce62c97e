#include "core/psychometric/procedure/adjusting.h"

#include <algorithm>
#include <cmath>
#include <string>

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
  ++presentations_;
  if (answer == 0.0) {
    settings_.push_back(level);
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
  const auto n = static_cast<double>(settings_.size());
  if (settings_.empty()) {
    return {};
  }
  double mean = 0.0;
  for (const double setting : settings_) {
    mean += setting / n;
  }
  Estimate estimate{"mean of " + std::to_string(settings_.size()) + " settings", mean, {}};
  if (settings_.size() > 1) {
    double squares = 0.0;
    for (const double setting : settings_) {
      squares += (setting - mean) * (setting - mean);
    }
    estimate.deviation = std::sqrt(squares / (n - 1.0) / n);
  }
  return {estimate};
}

}  // namespace haptrial::psychometric
