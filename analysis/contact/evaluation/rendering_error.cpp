#include "analysis/contact/evaluation/rendering_error.h"

#include <fmt/format.h>
#include <gsl/gsl_fft_real.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <stdexcept>

namespace haptrial::evaluation {
namespace {

using Vectors = std::span<const Eigen::Vector3d>;

constexpr double kSlowBelow = 10.0, kFastFrom = 100.0;         // [Hz]
constexpr double kLowThreshold = 0.07, kHighThreshold = 0.10;  // of the force
constexpr double kLeastJudged = 2.5, kLargestJudged = 10.0;    // of a force [N]

void check_pair(Vectors a, Vectors b) {
  if (a.size() != b.size() || a.empty()) {
    throw std::invalid_argument("measured and rendered must be equally many, one or more");
  }
  for (std::size_t i = 0; i < a.size(); ++i) {
    if (!a[i].allFinite() || !b[i].allFinite()) {
      throw std::invalid_argument("measured and rendered must be finite; sample " +
                                  std::to_string(i) + " is not");
    }
  }
}

/// Adds the mean squares of the bands of one component.
void add_bands(std::vector<double> values, double rate, BandError& squares) {
  const std::size_t n = values.size();
  const std::unique_ptr<gsl_fft_real_wavetable, decltype(&gsl_fft_real_wavetable_free)> table(
      gsl_fft_real_wavetable_alloc(n), gsl_fft_real_wavetable_free);
  const std::unique_ptr<gsl_fft_real_workspace, decltype(&gsl_fft_real_workspace_free)> space(
      gsl_fft_real_workspace_alloc(n), gsl_fft_real_workspace_free);
  gsl_fft_real_transform(values.data(), 1, n, table.get(), space.get());
  const double scale = 1.0 / (static_cast<double>(n) * static_cast<double>(n));
  // Half-complex: the mean, then pairs; the last one alone if n is even.
  for (std::size_t j = 0; j < n; ++j) {
    const std::size_t bin = (j + 1) / 2;
    const bool alone = j == 0 || (n % 2 == 0 && j == n - 1);
    const double square = (alone ? 1.0 : 2.0) * scale * values[j] * values[j];
    const double frequency = static_cast<double>(bin) * rate / static_cast<double>(n);
    (frequency < kSlowBelow  ? squares.slow
     : frequency < kFastFrom ? squares.middle
                             : squares.fast) += square;
  }
}

double by_rank(std::vector<double>& values, double share) {
  const double rank = std::ceil(share * static_cast<double>(values.size()) - 1e-9);
  const auto at = static_cast<std::ptrdiff_t>(std::max(1.0, rank)) - 1;
  std::nth_element(values.begin(), values.begin() + at, values.end());
  return values[static_cast<std::size_t>(at)];
}

std::string verdict(const NoticeableError& e) {
  if (e.samples == 0) {
    return "No sample has a force large enough to judge.";
  }
  const char* said = e.beyond_low <= 0.05   ? "would rarely be noticed"
                     : e.beyond_high >= 0.5 ? "would be noticed most of the time"
                                            : "would be noticed now and then";
  std::string sentences = fmt::format(
      "The error {}: it is beyond 7 % of the force in {:.1f} % of the samples and beyond 10 % in "
      "{:.1f} %.",
      said, 100.0 * e.beyond_low, 100.0 * e.beyond_high);
  if (e.outside > 0.0) {
    sentences += fmt::format(
        " These thresholds were measured from {} to {} N; {:.0f} % of the samples lie outside.",
        kLeastJudged, kLargestJudged, 100.0 * e.outside);
  }
  return sentences;
}

}  // namespace

ForceError force_error(Vectors measured, Vectors rendered) {
  check_pair(measured, rendered);
  ForceError error;
  double squares = 0.0;
  const double n = static_cast<double>(measured.size());
  for (std::size_t i = 0; i < measured.size(); ++i) {
    const double norm = (measured[i] - rendered[i]).norm();
    error.mean_norm += norm / n;
    squares += norm * norm / n;
    error.worst = std::max(error.worst, norm);
    error.mean_force += measured[i].norm() / n;
  }
  error.root_mean_square = std::sqrt(squares);
  return error;
}

BandError band_error(Vectors measured, Vectors rendered, double rate) {
  check_pair(measured, rendered);
  if (!(rate > 0.0 && std::isfinite(rate))) {
    throw std::invalid_argument("rate must be above 0 and finite");
  }
  BandError squares;
  for (int axis = 0; axis < 3; ++axis) {
    std::vector<double> values;
    for (std::size_t i = 0; i < measured.size(); ++i) {
      values.push_back(measured[i][axis] - rendered[i][axis]);
    }
    add_bands(std::move(values), rate, squares);
  }
  return {std::sqrt(squares.slow), std::sqrt(squares.middle), std::sqrt(squares.fast),
          std::sqrt(squares.slow + squares.middle + squares.fast)};
}

PositionError position_error(Vectors recorded, Vectors rendered, double threshold) {
  const ForceError sizes = force_error(recorded, rendered);
  if (!(threshold >= 0.0)) {
    throw std::invalid_argument("threshold must not be negative");
  }
  PositionError error{sizes.mean_norm, sizes.root_mean_square, sizes.worst, 0.0, {}};
  for (std::size_t i = 0; i < recorded.size(); ++i) {
    const double norm = (recorded[i] - rendered[i]).norm();
    if (!(norm > threshold)) {
      continue;
    }
    error.beyond_share += 1.0 / static_cast<double>(recorded.size());
    if (error.places.empty() || error.places.back().last + 1 != i) {
      error.places.push_back({i, i, norm});
      continue;
    }
    ProblemPlace& place = error.places.back();
    place.last = i;
    place.worst = std::max(place.worst, norm);
  }
  return error;
}

NoticeableError noticeable_error(Vectors measured, Vectors rendered, double least_force) {
  check_pair(measured, rendered);
  if (!(least_force >= 0.0)) {
    throw std::invalid_argument("least_force must not be negative");
  }
  NoticeableError error;
  std::vector<double> thresholds;
  std::size_t outside = 0;
  for (std::size_t i = 0; i < measured.size(); ++i) {
    const double force = measured[i].norm();
    if (force > least_force) {
      thresholds.push_back((measured[i] - rendered[i]).norm() / (kLowThreshold * force));
      outside += force < kLeastJudged || force > kLargestJudged;
    }
  }
  error.samples = thresholds.size();
  if (error.samples > 0) {
    const auto share_beyond = [&](double limit) {
      return static_cast<double>(std::count_if(thresholds.begin(), thresholds.end(),
                                               [limit](double x) { return x > limit; })) /
             static_cast<double>(thresholds.size());
    };
    error.beyond_low = share_beyond(1.0);
    error.beyond_high = share_beyond(kHighThreshold / kLowThreshold);
    error.median = by_rank(thresholds, 0.5);
    error.outside = static_cast<double>(outside) / static_cast<double>(thresholds.size());
  }
  error.verdict = verdict(error);
  return error;
}

TickTimes tick_times(std::span<const double> times) {
  if (times.empty()) {
    throw std::invalid_argument("times of ticks must be one or more");
  }
  std::vector<double> sorted(times.begin(), times.end());
  return {by_rank(sorted, 0.5), by_rank(sorted, 0.999),
          *std::max_element(sorted.begin(), sorted.end())};
}

}  // namespace haptrial::evaluation
