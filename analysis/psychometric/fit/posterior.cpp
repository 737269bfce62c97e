#include "analysis/psychometric/fit/posterior.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <stdexcept>

#include "core/base/parallel.h"

namespace haptrial::analysis {
namespace {

constexpr double kNever = -std::numeric_limits<double>::infinity();
constexpr double kSmallest = 1e-35;
constexpr int kTogether = 8;  // factors of at least kSmallest whose product is a normal number

/// Places of eta that are computed side by side.
constexpr std::size_t kEtaLanes = 4;

/// Products of many factors, each in (0, 1], beside their power of two.
struct Products {
  std::vector<double> value;
  std::vector<std::int64_t> power;

  explicit Products(std::size_t lanes) : value(lanes), power(lanes) {}

  void start() {
    std::fill(value.begin(), value.end(), 1.0);
    std::fill(power.begin(), power.end(), 0);
  }

  /// Moves the exponents out of the values.
  void normalise() {
    constexpr std::uint64_t kFraction = (std::uint64_t{1} << 52) - 1, kOne = 1023;
    for (std::size_t e = 0; e < value.size(); ++e) {
      const auto bits = std::bit_cast<std::uint64_t>(value[e]);
      power[e] += static_cast<std::int64_t>(bits >> 52) - static_cast<std::int64_t>(kOne);
      value[e] = std::bit_cast<double>((bits & kFraction) | (kOne << 52));
    }
  }

  double log_of(std::size_t e) const {
    constexpr double kLog2 = 0.69314718055994530942;
    return std::log(value[e]) + kLog2 * static_cast<double>(power[e]);
  }
};

double log_of(double density) { return density > 0.0 ? std::log(density) : kNever; }

}  // namespace

std::vector<double> trapezoid_weights(std::span<const double> values) {
  const std::size_t n = values.size();
  if (n == 1) {
    return {1.0};
  }
  std::vector<double> weights(n, 0.0);
  for (std::size_t i = 1; i < n; ++i) {
    const double half = 0.5 * (values[i] - values[i - 1]);
    weights[i - 1] += half;
    weights[i] += half;
  }
  return weights;
}

/// Values that depend on eta and the number of an answer, and the priors.
struct PsychometricPosterior::Table {
  std::size_t lanes;             // etas, filled up to whole groups
  std::vector<double> slope;     // (answers x lanes) 1 / (1 + j / v)
  std::vector<double> offset;    // (answers x lanes) (j / v) / (1 + j / v)
  std::vector<double> constant;  // (lanes) what the factors have too much, and the prior of eta
  std::array<std::vector<double>, kDimensions> log_prior;

  Table(const PsychometricPosterior& posterior, const GridAxes& axes)
      : lanes((axes[kEta].size() + kEtaLanes - 1) / kEtaLanes * kEtaLanes) {
    const auto answers = static_cast<std::size_t>(posterior.most_answers_);
    slope.resize(answers * lanes);
    offset.resize(answers * lanes);
    constant.assign(lanes, 0.0);
    for (std::size_t d = 0; d < kDimensions; ++d) {
      for (const double value : axes[d]) {
        log_prior[d].push_back(posterior.log_prior(static_cast<Dimension>(d), value));
      }
    }
    for (std::size_t e = 0; e < lanes; ++e) {
      add_eta(posterior, e, axes[kEta][std::min(e, axes[kEta].size() - 1)]);
    }
  }

  void add_eta(const PsychometricPosterior& posterior, std::size_t e, double eta) {
    const double step = eta * eta / ((1.0 - eta) * (1.0 + eta));  // 1 / v
    const auto answers = static_cast<std::size_t>(posterior.most_answers_);
    for (std::size_t j = 0; j < answers; ++j) {
      const double above = 1.0 + static_cast<double>(j) * step;
      slope[j * lanes + e] = 1.0 / above;
      offset[j * lanes + e] = static_cast<double>(j) * step / above;
    }
    const auto logs = [&](int from, int to) {
      double sum = 0.0;
      for (int j = from; j < to; ++j) {
        sum += std::log1p(j * step);
      }
      return sum;
    };
    for (const TrialBlock& block : posterior.blocks_) {
      const int wrong = block.total - block.correct;
      const int large = std::max(block.correct, wrong), small = std::min(block.correct, wrong);
      constant[e] += logs(0, small) - logs(large, block.total);
    }
  }

  /// Multiplies (p + j / v) / (1 + j / v) for j = 0 .. count - 1 into the products.
  void multiply(Products& products, double p, int count) const {
    for (int first = 0; first < count; first += kTogether) {
      const int last = std::min(count, first + kTogether);
      for (int j = first; j < last; ++j) {
        const double* a = slope.data() + static_cast<std::size_t>(j) * lanes;
        const double* b = offset.data() + static_cast<std::size_t>(j) * lanes;
        double* value = products.value.data();
        for (std::size_t e = 0; e < lanes; ++e) {
          value[e] *= p * a[e] + b[e];
        }
      }
      products.normalise();
    }
  }
};

PsychometricPosterior::PsychometricPosterior(
    const psychometric::PsychometricParameters& shape, Task task,
    std::span<const TrialBlock> blocks, const PsychometricPrior& prior,
    const std::array<std::optional<double>, kDimensions>& fixed)
    : curve_(psychometric::curve_of(shape)),
      task_(task),
      blocks_(blocks.begin(), blocks.end()),
      coordinates_(coordinates(shape.axis, blocks)),
      prior_(prior) {
  for (std::size_t d = 0; d < kDimensions; ++d) {
    fixed_[d] = fixed[d].has_value();
  }
  fixed_[kGuess] = fixed_[kGuess] || task != Task::kYesNo;
  for (const TrialBlock& block : blocks_) {
    most_answers_ = std::max({most_answers_, block.correct, block.total - block.correct});
  }
}

double PsychometricPosterior::log_prior(Dimension dimension, double value) const {
  return fixed_[dimension] ? 0.0 : log_of(prior_.density(dimension, value));
}

double PsychometricPosterior::log_density(const FittedParameters& p) const {
  const GridAxes here{std::vector{p.threshold}, std::vector{p.width}, std::vector{p.lapse},
                      std::vector{p.guess}, std::vector{p.eta}};
  if (!(p.width > 0.0 && p.lapse >= 0.0 && p.guess >= 0.0 && p.lapse + p.guess < 1.0 &&
        p.eta >= 0.0 && p.eta < 1.0)) {
    return kNever;
  }
  double result = kNever;
  fill(here, Table(*this, here), 0, &result);
  return result;
}

/// State while one threshold's slice is filled.
struct PsychometricPosterior::Slice {
  std::vector<double> share, beyond;  // of each block, S and 1 - S
  Products products;
};

/// The products of all answers at these asymptotes; false where they are 0.
bool PsychometricPosterior::multiply(const Table& table, double lapse, double guess,
                                     Slice& slice) const {
  slice.products.start();
  const double between = 1.0 - guess - lapse;
  for (std::size_t i = 0; i < blocks_.size(); ++i) {
    const int right = blocks_[i].correct, wrong = blocks_[i].total - right;
    const double p = guess + between * slice.share[i];
    const double q = lapse + between * slice.beyond[i];
    if ((p <= 0.0 && right > 0) || (q <= 0.0 && wrong > 0)) {
      return false;
    }
    table.multiply(slice.products, std::max(p, kSmallest), right);
    table.multiply(slice.products, std::max(q, kSmallest), wrong);
  }
  return true;
}

// The loop over eta is inside, as only a few numbers depend on it.
void PsychometricPosterior::fill(const GridAxes& axes, const Table& table, std::size_t threshold,
                                 double* out) const {
  const std::size_t etas = axes[kEta].size();
  Slice slice{std::vector<double>(blocks_.size()), std::vector<double>(blocks_.size()),
              Products(table.lanes)};
  for (std::size_t w = 0; w < axes[kWidth].size(); ++w) {
    const double prior = table.log_prior[kThreshold][threshold] + table.log_prior[kWidth][w];
    for (std::size_t i = 0; i < blocks_.size(); ++i) {
      const psychometric::SigmoidPoint s =
          curve_.at(coordinates_[i], axes[kThreshold][threshold], axes[kWidth][w]);
      slice.share[i] = s.share;
      slice.beyond[i] = s.beyond;
    }
    for (std::size_t l = 0; l < axes[kLapse].size(); ++l) {
      for (std::size_t g = 0; g < axes[kGuess].size(); ++g, out += etas) {
        const double lapse = axes[kLapse][l];
        const double guess = task_ == Task::kEqualAsymptote ? lapse : axes[kGuess][g];
        const double rates = prior + table.log_prior[kLapse][l] + table.log_prior[kGuess][g];
        const bool possible = rates > kNever && multiply(table, lapse, guess, slice);
        for (std::size_t e = 0; e < etas; ++e) {
          out[e] = possible ? slice.products.log_of(e) + table.constant[e] + rates +
                                  table.log_prior[kEta][e]
                            : kNever;
        }
      }
    }
  }
}

namespace {

/// Turns a slice of logarithms of densities into masses. @returns their sum.
double to_masses(double* cell, double log_largest, double around,
                 const std::array<std::vector<double>, kDimensions>& weights) {
  double sum = 0.0;
  for (const double w : weights[kWidth]) {
    for (const double l : weights[kLapse]) {
      for (const double g : weights[kGuess]) {
        for (const double e : weights[kEta]) {
          *cell = around * w * l * g * e * std::exp(*cell - log_largest);
          sum += *cell++;
        }
      }
    }
  }
  return sum;
}

}  // namespace

PsychometricPosterior::Masses PsychometricPosterior::on(const GridAxes& axes, int threads) const {
  const std::size_t slices = axes[kThreshold].size();
  const std::size_t size =
      axes[kWidth].size() * axes[kLapse].size() * axes[kGuess].size() * axes[kEta].size();
  const Table table(*this, axes);
  Masses masses;
  masses.cells.resize(slices * size);
  parallel_for(slices, threads,
               [&](std::size_t a) { fill(axes, table, a, masses.cells.data() + a * size); });
  const auto largest = std::max_element(masses.cells.begin(), masses.cells.end());
  masses.log_largest = *largest;
  if (!std::isfinite(masses.log_largest)) {
    throw std::invalid_argument(
        "blocks: with the fixed parameters, no psychometric function gives these answers");
  }
  auto place = static_cast<std::size_t>(largest - masses.cells.begin());
  std::array<std::vector<double>, kDimensions> weights;
  for (std::size_t d = kDimensions; d-- > 0;) {
    masses.largest[d] = place % axes[d].size();
    place /= axes[d].size();
    weights[d] = trapezoid_weights(axes[d]);
  }
  std::vector<double> sums(slices, 0.0);
  parallel_for(slices, threads, [&](std::size_t a) {
    sums[a] = to_masses(masses.cells.data() + a * size, masses.log_largest, weights[kThreshold][a],
                        weights);
  });
  for (const double sum : sums) {
    masses.sum += sum;
  }
  return masses;
}

}  // namespace haptrial::analysis
