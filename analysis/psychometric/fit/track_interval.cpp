#include "analysis/psychometric/fit/track_interval.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include "core/base/random.h"

namespace haptrial::analysis {
namespace {

constexpr std::size_t kFewest = 100;  // errors
constexpr double kTail = 0.025;

/// Bias of a track's own estimate, and its deviation.
struct TrackError {
  double error{0.0}, deviation{0.0};  // [axis]
};

/// The deviation of an estimate on the axis; 0: it has none.
double deviation_of(const psychometric::Estimate& e, const psychometric::Axis& axis) {
  const double deviation = e.deviation ? *e.deviation * axis.gradient(e.value) : 0.0;
  return std::isfinite(deviation) ? deviation : 0.0;
}

/// One more such track; nothing: it gives no estimate.
std::optional<TrackError> simulated(const FinishedTrack& track,
                                    const psychometric::PsychometricFunction& observer,
                                    double target, RandomStream& random) {
  const auto procedure = track.begin();
  for (std::size_t i = 0; !procedure->finished() && (track.finished || i < track.trials); ++i) {
    const psychometric::Level level = procedure->next();
    procedure->report(random.uniform() < observer(level[0]) ? 1.0 : 0.0, level);
  }
  const auto estimates = procedure->estimates();
  if (estimates.empty()) {
    return std::nullopt;
  }
  const psychometric::Axis& axis = observer.parameters().axis;
  const double error = axis.at(estimates.front().value) - observer.x_for(target);
  return std::isfinite(error)
             ? std::optional(TrackError{error, deviation_of(estimates.front(), axis)})
             : std::nullopt;
}

double variance_of(const std::vector<TrackError>& errors) {
  double mean = 0.0, squares = 0.0;
  const auto n = static_cast<double>(errors.size());
  for (const TrackError& e : errors) {
    mean += e.error / n;
  }
  for (const TrackError& e : errors) {
    squares += (e.error - mean) * (e.error - mean);
  }
  return squares / (n - 1.0);
}

double quantile_of_sorted(const std::vector<double>& values, double share) {
  const double at = share * static_cast<double>(values.size() - 1);
  const auto i = static_cast<std::size_t>(at);
  const double next = values[std::min(i + 1, values.size() - 1)];
  return values[i] + (at - static_cast<double>(i)) * (next - values[i]);
}

}  // namespace

Defined<CredibleInterval> track_interval(const FinishedTrack& track,
                                         const psychometric::PsychometricParameters& shape,
                                         std::span<const FittedParameters> draws,
                                         std::uint64_t seed) {
  const std::optional<double> target = track.begin()->target();
  if (!target) {
    return Undefined{"the procedure seeks no level of a known probability"};
  }
  const auto curve = psychometric::curve_of(shape);
  RandomStream random(seed, "track interval");
  std::vector<TrackError> errors;
  for (const FittedParameters& draw : draws) {
    if (*target <= draw.guess || *target >= 1.0 - draw.lapse) {
      continue;
    }
    if (const auto error = simulated(track, fitted_function(shape, curve, draw), *target, random)) {
      errors.push_back(*error);
    }
  }
  if (errors.size() < kFewest) {
    return Undefined{"too few simulated tracks of such observers have an estimate"};
  }
  const double variance = variance_of(errors);
  const auto scale = [variance](double deviation) {
    return std::sqrt(deviation * deviation + variance);
  };
  const double own = scale(deviation_of(track.estimate, shape.axis));
  std::vector<double> scaled;
  for (const TrackError& e : errors) {
    scaled.push_back(variance > 0.0 ? e.error / scale(e.deviation) * own : e.error);
  }
  std::sort(scaled.begin(), scaled.end());
  const double x = shape.axis.at(track.estimate.value);
  return CredibleInterval{shape.axis.level(x - quantile_of_sorted(scaled, 1.0 - kTail)),
                          shape.axis.level(x - quantile_of_sorted(scaled, kTail))};
}

}  // namespace haptrial::analysis
