#include "analysis/force_training/score/resample.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

#include "core/base/error.h"

namespace haptrial::analysis {
namespace {

void check(const TimeBase& base) {
  if (!(base.duration > 0.0 && std::isfinite(base.duration)) || base.samples < 2) {
    throw std::invalid_argument("a time base needs a duration above 0 and at least two samples");
  }
}

void check(std::span<const double> force, const TimeBase& base) {
  check(base);
  if (force.size() != base.samples) {
    throw std::invalid_argument("a curve and its time base must have the same number of samples");
  }
}

/// Straight lines between values at 0, 1, 2, ...; `at` lies in [0, values.size() - 1].
double interpolate(std::span<const double> values, double at) {
  const auto index = std::min(static_cast<std::size_t>(at), values.size() - 2);
  const double part = at - static_cast<double>(index);
  return (1.0 - part) * values[index] + part * values[index + 1];
}

/// The integral from instant 0 to `at`, in steps, of straight lines between `values`.
/// @param whole  the same at every sample.
double integral_to(std::span<const double> values, std::span<const double> whole, double at) {
  const auto index = std::min(static_cast<std::size_t>(at), values.size() - 2);
  const double part = at - static_cast<double>(index);
  return whole[index] + part * (values[index] + 0.5 * part * (values[index + 1] - values[index]));
}

std::vector<double> resample_at_rate(const SampledCurve& curve, const TimeBase& base) {
  const double last = static_cast<double>(curve.values.size() - 1);
  const double in_samples = base.duration * curve.rate;
  // A duration that came from duration_of() must end on the last sample whatever it was rounded to.
  const double end = std::abs(in_samples - last) <= 1e-9 * last ? last : in_samples;
  const double intervals = static_cast<double>(base.samples - 1);
  std::vector<double> result(base.samples);
  for (std::size_t k = 0; k < base.samples; ++k) {
    const double at = end * (static_cast<double>(k) / intervals);
    result[k] = at >= last ? curve.values.back() : interpolate(curve.values, at);
  }
  return result;
}

std::vector<double> resample_at_times(const SampledCurve& curve, const TimeBase& base) {
  const double start = curve.times.front(), duration = curve.times.back() - start;
  const double intervals = static_cast<double>(base.samples - 1);
  std::vector<double> result(base.samples);
  std::size_t after = 1;  // the first sample later than the instant
  for (std::size_t k = 0; k < base.samples; ++k) {
    const double at = base.duration * (static_cast<double>(k) / intervals);
    if (at >= duration) {
      result[k] = curve.values.back();
      continue;
    }
    while (curve.times[after] - start <= at) {
      ++after;
    }
    const double from = curve.times[after - 1] - start, to = curve.times[after] - start;
    const double part = (at - from) / (to - from);
    result[k] = (1.0 - part) * curve.values[after - 1] + part * curve.values[after];
  }
  return result;
}

}  // namespace

SampledCurve view(const ForceCurve& curve) { return {curve.force, {}, curve.rate}; }

double duration_of(const SampledCurve& curve, const char* name) {
  const auto fail = [&](const std::string& found, const char* allowed) {
    throw InputError(std::string(name) + " " + found + "; allowed: " + allowed);
  };
  const std::size_t samples = curve.values.size();
  if (samples < 2) {
    fail("has " + std::to_string(samples) + " samples", "at least two");
  }
  const bool timed = !curve.times.empty();
  if (!timed && !(curve.rate > 0.0 && std::isfinite(curve.rate))) {
    fail("has a rate of " + std::to_string(curve.rate) + " Hz", "a finite number above 0");
  }
  const auto bad = std::find_if_not(curve.values.begin(), curve.values.end(),
                                    [](double value) { return std::isfinite(value); });
  if (bad != curve.values.end()) {
    fail(
        "is " + std::to_string(*bad) + " N at sample " + std::to_string(bad - curve.values.begin()),
        "finite forces");
  }
  if (!timed) {
    return static_cast<double>(samples - 1) / curve.rate;
  }
  if (curve.times.size() != samples) {
    fail("has " + std::to_string(curve.times.size()) + " times for " + std::to_string(samples) +
             " samples",
         "as many");
  }
  for (std::size_t k = 1; k < samples; ++k) {
    if (!(curve.times[k] > curve.times[k - 1])) {
      fail("has a time at sample " + std::to_string(k) + " that is not above the one before",
           "times that increase");
    }
  }
  const double duration = curve.times.back() - curve.times.front();
  if (!std::isfinite(duration)) {
    fail("lasts too long to count in seconds", "finite times");
  }
  return duration;
}

double duration_of(const ForceCurve& curve, const char* name) {
  return duration_of(view(curve), name);
}

std::vector<double> resample(const SampledCurve& curve, const TimeBase& base) {
  check(base);
  return curve.times.empty() ? resample_at_rate(curve, base) : resample_at_times(curve, base);
}

std::vector<double> resample(const ForceCurve& curve, const TimeBase& base) {
  return resample(view(curve), base);
}

std::vector<double> box_filter(std::span<const double> force, const TimeBase& base, double width) {
  check(force, base);
  if (!(width >= 0.0 && std::isfinite(width))) {
    throw std::invalid_argument("the width of a box filter must be finite and at least 0");
  }
  std::vector<double> whole(force.size(), 0.0);
  for (std::size_t k = 1; k < force.size(); ++k) {
    whole[k] = whole[k - 1] + 0.5 * (force[k - 1] + force[k]);
  }
  const double half_width = 0.5 * width / base.step();  // in steps
  const double last = static_cast<double>(force.size() - 1);
  std::vector<double> result(force.begin(), force.end());
  if (half_width == 0.0) {
    return result;
  }
  for (std::size_t k = 1; k + 1 < force.size(); ++k) {
    const double at = static_cast<double>(k);
    const double half = std::min({half_width, at, last - at});
    result[k] = (integral_to(force, whole, at + half) - integral_to(force, whole, at - half)) /
                (2.0 * half);
  }
  return result;
}

std::vector<double> slope(std::span<const double> force, const TimeBase& base) {
  check(force, base);
  const double step = base.step();
  const std::size_t last = force.size() - 1;
  std::vector<double> result(force.size());
  result[0] = (force[1] - force[0]) / step;
  result[last] = (force[last] - force[last - 1]) / step;
  for (std::size_t k = 1; k < last; ++k) {
    result[k] = (force[k + 1] - force[k - 1]) / (2.0 * step);
  }
  return result;
}

}  // namespace haptrial::analysis
