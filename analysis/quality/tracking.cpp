#include "analysis/quality/tracking.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "analysis/statistics/base/descriptive.h"

namespace haptrial::analysis {
namespace {

// Correlation of actual[k + lag] with ideal[k] over the overlap; 0 where either is constant.
double correlation(std::span<const double> actual, std::span<const double> ideal, long lag) {
  const auto shift = static_cast<std::size_t>(std::abs(lag));
  const auto count = static_cast<Eigen::Index>(actual.size() - shift);
  const Eigen::Map<const Eigen::ArrayXd> a(actual.data() + (lag > 0 ? shift : 0), count);
  const Eigen::Map<const Eigen::ArrayXd> b(ideal.data() + (lag > 0 ? 0 : shift), count);
  const double mean_a = a.mean();
  const double mean_b = b.mean();
  const double aa = (a - mean_a).square().sum();
  const double bb = (b - mean_b).square().sum();
  const double ab = ((a - mean_a) * (b - mean_b)).sum();
  return aa > 0.0 && bb > 0.0 ? ab / std::sqrt(aa * bb) : 0.0;
}

bool varies(std::span<const double> values) {
  const auto [low, high] = std::minmax_element(values.begin(), values.end());
  return low != values.end() && *high - *low > 1e-12 * std::max(std::abs(*low), std::abs(*high));
}

// The lag of the highest correlation from low to high.
long best_lag(std::span<const double> actual, std::span<const double> ideal, long low, long high) {
  long best = low;
  double highest = -2.0;
  for (long lag = low; lag <= high; ++lag) {
    if (const double r = correlation(actual, ideal, lag); r > highest) {
      highest = r;
      best = lag;
    }
  }
  return best;
}

std::vector<double> every(std::span<const double> values, std::size_t step) {
  std::vector<double> result;
  result.reserve(values.size() / step + 1);
  for (std::size_t k = 0; k < values.size(); k += step) {
    result.push_back(values[k]);
  }
  return result;
}

// Coarse on every `step`th sample, then sample by sample around what was found.
long best_lag_within(std::span<const double> actual, std::span<const double> ideal, long reach,
                     long step) {
  const auto stride = static_cast<std::size_t>(step);
  const long steps = reach / step;
  const long coarse = step * best_lag(every(actual, stride), every(ideal, stride), -steps, steps);
  return best_lag(actual, ideal, std::max(-reach, coarse - step), std::min(reach, coarse + step));
}

Defined<double> root_mean(double squares, std::uint64_t count) {
  if (count == 0) {
    return Undefined{"there are no samples"};
  }
  return std::sqrt(squares / static_cast<double>(count));
}

}  // namespace

IdealPath::IdealPath(std::vector<record::StimulusRow> rows) : rows_(std::move(rows)) {
  if (rows_.empty()) {
    throw std::invalid_argument("IdealPath: there are no rows");
  }
  for (std::size_t i = 1; i < rows_.size(); ++i) {
    if (!(rows_[i].time > rows_[i - 1].time)) {
      throw std::invalid_argument("IdealPath: the times do not increase");
    }
  }
}

Eigen::Vector3d IdealPath::position(double time) const {
  const auto after = std::upper_bound(rows_.begin(), rows_.end(), time,
                                      [](double t, const auto& row) { return t < row.time; });
  if (after == rows_.begin()) {
    return rows_.front().position;
  }
  if (after == rows_.end()) {
    return rows_.back().position;
  }
  const auto& a = *(after - 1);
  const double part = (time - a.time) / (after->time - a.time);
  return a.position + part * (after->position - a.position);
}

Defined<double> lag_behind(std::span<const double> actual, std::span<const double> ideal,
                           double rate, double max_lag) {
  if (actual.size() != ideal.size()) {
    throw std::invalid_argument("lag_behind: the curves differ in length");
  }
  // The reach leaves at least half of the curves overlapping at every shift.
  const long reach = std::min(std::lround(max_lag * rate), static_cast<long>(actual.size() / 2));
  if (reach < 2 || !varies(actual) || !varies(ideal)) {
    return Undefined{"the path does not vary"};
  }
  // The paths change little within a hundredth of a second.
  const long step = std::max(1L, std::lround(0.01 * rate));
  const long best = best_lag_within(actual, ideal, reach, step);
  if (std::abs(best) == reach) {
    return Undefined{"the correlation is highest at the edge of the search"};
  }
  const double before = correlation(actual, ideal, best - 1);
  const double peak = correlation(actual, ideal, best);
  const double after = correlation(actual, ideal, best + 1);
  const double curvature = before - 2.0 * peak + after;
  const double fraction = curvature < 0.0 ? 0.5 * (before - after) / curvature : 0.0;
  return (static_cast<double>(best) + fraction) / rate;
}

PassTracking track_pass(std::span<const double> times, std::span<const Eigen::Vector3d> positions,
                        const IdealPath& ideal, double rate) {
  PassTracking result;
  result.samples = times.size();
  result.duration = times.empty() ? 0.0 : times.back();
  std::vector<double> actual_z(times.size());
  std::vector<double> ideal_z(times.size());
  for (std::size_t k = 0; k < times.size(); ++k) {
    const Eigen::Vector3d target = ideal.position(times[k]);
    const Eigen::Vector3d error = positions[k] - target;
    result.squares += error.squaredNorm();
    result.squares_in_plane += error.x() * error.x() + error.z() * error.z();
    actual_z[k] = positions[k].z();
    ideal_z[k] = target.z();
  }
  result.lag = lag_behind(actual_z, ideal_z, rate);
  return result;
}

TrackingSummary summarize_tracking(std::string subject, std::span<const PassTracking> passes) {
  TrackingSummary result;
  result.subject = std::move(subject);
  result.passes = passes.size();
  std::vector<double> lags;
  std::vector<double> runs;
  std::uint64_t samples = 0;
  double squares = 0.0;
  double squares_in_plane = 0.0;
  for (const auto& pass : passes) {
    if (pass.lag) {
      lags.push_back(*pass.lag);
    }
    runs.push_back(pass.duration);
    samples += pass.samples;
    squares += pass.squares;
    squares_in_plane += pass.squares_in_plane;
  }
  result.passes_without_lag = passes.size() - lags.size();
  if (const auto m = moments(lags)) {
    result.lag = m->mean();
    if (m->count > 1) {
      result.lag_deviation = std::sqrt(m->variance());
    }
  }
  if (const auto m = moments(runs)) {
    result.run = m->mean();
    if (m->count > 1) {
      result.run_deviation = std::sqrt(m->variance());
    }
  }
  result.rms_error = root_mean(squares, samples);
  result.rms_error_in_plane = root_mean(squares_in_plane, samples);
  return result;
}

}  // namespace haptrial::analysis
