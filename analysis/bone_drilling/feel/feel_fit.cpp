#include "analysis/bone_drilling/feel/feel_fit.h"

#include <fmt/format.h>

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "analysis/files/csv.h"
#include "analysis/statistics/base/decomposition.h"
#include "analysis/statistics/base/distributions.h"
#include "core/base/error.h"

namespace haptrial::analysis::drilling {
namespace {

constexpr std::size_t kFewest = 20;  // samples that are fitted

double area(double radius, double depth) noexcept {
  return std::numbers::pi * depth * (2.0 * radius - depth);
}

/// Forces that are fitted, each with its immersed volume.
struct Forces {
  Eigen::VectorXd volume;  // [m^3]
  Eigen::VectorXd force;   // [N]
};

Eigen::MatrixXd gain_columns(const Eigen::VectorXd& volume, double threshold) {
  Eigen::MatrixXd columns(volume.size(), 2);
  columns.col(0) = volume.cwiseMin(threshold);
  columns.col(1) = (volume.array() - threshold).max(0.0);
  return columns;
}

/// Gains that are best with a threshold, and the sum of squares that they leave.
struct Gains {
  Eigen::VectorXd slopes;
  double squares{std::numeric_limits<double>::infinity()};
};
Gains gains_at(const Forces& f, double threshold) {
  const Eigen::MatrixXd columns = gain_columns(f.volume, threshold);
  Gains gains;
  gains.slopes = least_squares(columns, f.force).slopes;
  gains.squares = (f.force - columns * gains.slopes).squaredNorm();
  return gains;
}

/// The threshold that leaves the least squares: by a scan of volumes, then by golden sections.
double best_threshold(const Forces& f) {
  std::vector<double> volumes(f.volume.data(), f.volume.data() + f.volume.size());
  std::ranges::sort(volumes);
  constexpr std::size_t kEdge = 5;  // samples on each side that a gain needs
  constexpr int kScanned = 60;
  const double low = volumes[kEdge], high = volumes[volumes.size() - 1 - kEdge];
  if (!(low < high)) {
    throw InputError("the recording has one depth only; press lightly and hard");
  }
  const double step = std::pow(high / low, 1.0 / kScanned);
  double best = low;
  for (int i = 0; i <= kScanned; ++i) {
    const double at = low * std::pow(step, i);
    best = gains_at(f, at).squares < gains_at(f, best).squares ? at : best;
  }
  double a = std::max(low, best / step), b = std::min(high, best * step);
  constexpr double kGolden = 0.6180339887498949;
  for (int i = 0; i < 40; ++i) {
    const double c = b - kGolden * (b - a), d = a + kGolden * (b - a);
    (gains_at(f, c).squares < gains_at(f, d).squares ? b : a) =
        gains_at(f, c).squares < gains_at(f, d).squares ? d : c;
  }
  return 0.5 * (a + b);
}

/// Estimates from the derivatives of a model by its parameters. @param squares  that are left
std::vector<FeelEstimate> with_intervals(const Eigen::VectorXd& values,
                                         const Eigen::MatrixXd& derivatives, double squares) {
  const auto df = static_cast<double>(derivatives.rows() - derivatives.cols());
  const Eigen::VectorXd scale = derivatives.colwise().norm();  // columns differ by many powers
  const Eigen::MatrixXd scaled = derivatives * scale.cwiseInverse().asDiagonal();
  const Eigen::MatrixXd inverse =
      least_squares(scaled, Eigen::VectorXd::Zero(derivatives.rows())).inverse;
  const double t = t_quantile(0.975, df);
  std::vector<FeelEstimate> estimates;
  for (Eigen::Index i = 0; i < values.size(); ++i) {
    const double half = t * std::sqrt(squares / df * inverse(i, i)) / scale[i];
    estimates.push_back({values[i], values[i] - half, values[i] + half});
  }
  return estimates;
}

void fit_forces(double radius, std::span<const FeelSample> samples, FeelFit& fit) {
  std::vector<double> volume, force;
  for (const FeelSample& sample : samples) {
    if (sample.depth > 0.0) {
      volume.push_back(immersed_volume(radius, sample.depth));
      force.push_back(sample.force);
    }
  }
  fit.pressed = volume.size();
  if (fit.pressed < kFewest) {
    throw InputError(fmt::format("the burr touches bone in {} samples; a fit needs {} at least",
                                 fit.pressed, kFewest));
  }
  const auto count = static_cast<Eigen::Index>(fit.pressed);
  const Forces f{Eigen::Map<Eigen::VectorXd>(volume.data(), count),
                 Eigen::Map<Eigen::VectorXd>(force.data(), count)};
  const double threshold = best_threshold(f);
  const Gains gains = gains_at(f, threshold);
  Eigen::MatrixXd derivatives(count, 3);
  derivatives.leftCols(2) = gain_columns(f.volume, threshold);
  const double kink = gains.slopes[0] - gains.slopes[1];
  derivatives.col(2) = kink * (f.volume.array() > threshold).cast<double>();
  const auto all = with_intervals(Eigen::Vector3d(gains.slopes[0], gains.slopes[1], threshold),
                                  derivatives, gains.squares);
  fit.first_gain = all[0];
  fit.second_gain = all[1];
  fit.threshold = all[2];
  fit.force_error = std::sqrt(gains.squares / static_cast<double>(count - 3));
}

/// Force of the fitted law, whose errors are less than those of a measured one [N].
double force_of(const FeelFit& fit, double volume) {
  const double threshold = fit.threshold.value;
  return fit.first_gain.value * std::min(volume, threshold) +
         fit.second_gain.value * std::max(0.0, volume - threshold);
}

void fit_removal(double radius, std::span<const FeelSample> samples, FeelFit& fit) {
  std::vector<const FeelSample*> drilled;
  for (const FeelSample& sample : samples) {
    if (sample.feed && sample.depth > 0.0) {
      drilled.push_back(&sample);
    }
  }
  fit.drilled = drilled.size();
  if (fit.drilled < kFewest) {
    return;
  }
  const auto count = static_cast<Eigen::Index>(drilled.size());
  Eigen::MatrixXd columns(count, 2);
  Eigen::VectorXd feed(count), latitude(count);
  for (Eigen::Index i = 0; i < count; ++i) {
    const FeelSample& sample = *drilled[static_cast<std::size_t>(i)];
    latitude[i] = mean_latitude(radius, sample.depth, sample.tilt);
    const double volume = immersed_volume(radius, sample.depth);
    columns(i, 0) = force_of(fit, volume) * volume / area(radius, sample.depth);
    columns(i, 1) = -columns(i, 0) * latitude[i];
    feed[i] = *sample.feed;
  }
  constexpr double kSpread = 0.1;  // of latitudes that tell rate and falloff apart [rad]
  if (latitude.maxCoeff() - latitude.minCoeff() < kSpread) {
    return;
  }
  const LeastSquares solved = least_squares(columns, feed);
  const double squares = (feed - columns * solved.slopes).squaredNorm();
  const auto all = with_intervals(solved.slopes, columns, squares);
  fit.removal_rate = all[0];
  fit.falloff = all[1];
}

}  // namespace

double immersed_volume(double radius, double depth) noexcept {
  const double h = std::clamp(depth, 0.0, 2.0 * radius);
  return std::numbers::pi * h * h * (radius - h / 3.0);
}

double mean_latitude(double radius, double depth, double tilt) noexcept {
  constexpr int kSteps = 12;  // midpoints along each of the three coordinates
  constexpr int kTurns = 24;
  const double c = std::cos(tilt), s = std::sin(tilt);
  double sum = 0.0, weight = 0.0;
  for (int i = 0; i < kSteps; ++i) {
    const double z = radius - depth * (i + 0.5) / kSteps;  // along the normal into bone
    const double disc = radius * radius - z * z;
    for (int j = 0; j < kSteps; ++j) {
      const double across = std::sqrt(disc * (j + 0.5) / kSteps);  // rings of equal area
      const double length = std::hypot(across, z);
      for (int k = 0; k < kTurns; ++k) {
        const double x = across * std::cos(2.0 * std::numbers::pi * (k + 0.5) / kTurns);
        sum += disc * std::abs(std::asin(std::clamp((c * z + s * x) / length, -1.0, 1.0)));
        weight += disc;
      }
    }
  }
  return sum / weight;
}

FeelFit fit_feel(double radius, std::span<const FeelSample> samples) {
  FeelFit fit;
  fit_forces(radius, samples, fit);
  fit_removal(radius, samples, fit);
  return fit;
}

std::vector<FeelSample> read_feel_samples(const CsvTable& table, double radius) {
  const std::vector<double> depth = table.numbers(table.column("depth"));
  const std::vector<double> force = table.numbers(table.column("force"));
  std::vector<FeelSample> samples(table.rows());
  std::vector<std::size_t> drilling;
  if (table.has("feed")) {
    for (std::size_t row = 0; row < table.rows(); ++row) {
      if (!table.text(row, table.column("feed")).empty()) {
        drilling.push_back(row);
      }
    }
    const std::vector<double> feed = table.numbers(table.column("feed"), drilling);
    for (std::size_t i = 0; i < drilling.size(); ++i) {
      samples[drilling[i]].feed = feed[i];
    }
  }
  const std::vector<double> tilt = table.has("tilt") ? table.numbers(table.column("tilt"))
                                                     : std::vector<double>(table.rows(), 0.0);
  for (std::size_t row = 0; row < table.rows(); ++row) {
    // Other units give numbers far outside: mm, mN, mm/s.
    constexpr double kHighest = 0.03;     // above bone [m]
    constexpr double kStrongest = 100.0;  // [N]
    constexpr double kFastest = 0.1;      // [m/s]
    if (!(depth[row] >= -kHighest && depth[row] < 2.0 * radius)) {
      table.refuse(
          row, table.column("depth"),
          fmt::format("from {:g} to below the burr's diameter, {:g} [m]", -kHighest, 2.0 * radius));
    }
    if (std::abs(force[row]) > kStrongest) {
      table.refuse(row, table.column("force"), "a force of at most 100 [N]");
    }
    if (std::abs(samples[row].feed.value_or(0.0)) > kFastest) {
      table.refuse(row, table.column("feed"), "a speed of at most 0.1 [m/s]");
    }
    if (!(tilt[row] >= 0.0 && tilt[row] <= 0.5 * std::numbers::pi)) {
      table.refuse(row, table.column("tilt"), "an angle from 0 to 1.5708 [rad]");
    }
    samples[row].depth = depth[row];
    samples[row].force = force[row];
    samples[row].tilt = tilt[row];
  }
  return samples;
}

}  // namespace haptrial::analysis::drilling
