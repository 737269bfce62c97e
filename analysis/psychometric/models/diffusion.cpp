#include "analysis/psychometric/models/diffusion.h"

#include <fmt/format.h>

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>
#include <optional>
#include <stdexcept>
#include <vector>

#include "analysis/statistics/base/decomposition.h"
#include "analysis/statistics/base/distributions.h"
#include "analysis/statistics/base/solvers.h"

namespace haptrial::analysis {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr double kRest = 1e-12;  // of a series

/// Terms of the series for small times that leave a rest below kRest.
double small_time_terms(double t) noexcept {
  const double scaled = 2.0 * std::sqrt(2.0 * kPi * t) * kRest;
  return scaled < 1.0 ? std::max(2.0 + std::sqrt(-2.0 * t * std::log(scaled)), std::sqrt(t) + 1.0)
                      : 2.0;
}

double large_time_terms(double t) noexcept {
  const double least = 1.0 / (kPi * std::sqrt(t));
  const double scaled = kPi * t * kRest;
  return scaled < 1.0 ? std::max(std::sqrt(-2.0 * std::log(scaled) / (kPi * kPi * t)), least)
                      : least;
}

/// Density at the lower boundary without drift, for boundaries at 0 and 1.
double standard_density(double t, double start) noexcept {
  const double small = small_time_terms(t), large = large_time_terms(t);
  double sum = 0.0;
  if (small < large) {
    const int half = static_cast<int>(std::ceil(0.5 * small));
    for (int k = -half; k <= half; ++k) {
      const double at = start + 2.0 * k;
      sum += at * std::exp(-0.5 * at * at / t);
    }
    return std::max(sum, 0.0) / std::sqrt(2.0 * kPi * t * t * t);
  }
  for (int k = 1; k <= static_cast<int>(std::ceil(large)); ++k) {
    sum += k * std::exp(-0.5 * k * k * kPi * kPi * t) * std::sin(k * kPi * start);
  }
  return std::max(kPi * sum, 0.0);
}

/// A candidate of the search: drift, logarithm of the boundary, non-decision time.
using DiffusionPlace = std::array<double, 3>;

Diffusion model_at(std::span<const double> place, double start) {
  return {place[0], std::exp(place[1]), place[2], start};
}

class DiffusionLikelihood {
 public:
  DiffusionLikelihood(std::span<const TimedChoice> choices, const DiffusionOptions& options)
      : choices_(choices), options_(options) {
    longest_ = std::ranges::max(choices, {}, &TimedChoice::time).time;
  }

  /// Not finite outside of the parameters' range.
  double operator()(std::span<const double> place) const {
    const Diffusion model = model_at(place, options_.start);
    if (place[2] < 0.0 || std::abs(place[1]) > 7.0) {
      return std::numeric_limits<double>::infinity();
    }
    const double floor = options_.contaminants / (2.0 * longest_);
    double sum = 0.0;
    for (const TimedChoice& each : choices_) {
      sum -= std::log(floor + (1.0 - options_.contaminants) *
                                  diffusion_density(model, each.upper, each.time));
    }
    return sum;
  }

 private:
  std::span<const TimedChoice> choices_;
  const DiffusionOptions& options_;
  double longest_{0.0};
};

/// Closed-form estimates from mean, variance and share. Source: Wagenmakers et al. 2007,
/// Psychonomic Bulletin & Review 14.
DiffusionPlace closed_form(std::span<const TimedChoice> choices, std::size_t uppers) {
  const auto n = static_cast<double>(choices.size());
  double mean = 0.0, squares = 0.0;
  for (const TimedChoice& each : choices) {
    mean += each.time / n;
  }
  for (const TimedChoice& each : choices) {
    squares += (each.time - mean) * (each.time - mean) / (n - 1.0);
  }
  const double observed = (static_cast<double>(uppers) + 0.5) / (n + 1.0);
  const double odds = std::max(std::abs(std::log(observed / (1.0 - observed))), 0.1);
  const double share = 1.0 / (1.0 + std::exp(-odds));
  const double shape = odds * (odds * share * (share - 1.0) + share - 0.5);
  const double drift = std::pow(shape / std::max(squares, 1e-6), 0.25);
  const double boundary = odds / drift;
  const double decision = boundary / (2.0 * drift) * std::tanh(0.5 * odds);
  const double soonest = std::ranges::min(choices, {}, &TimedChoice::time).time;
  const double rest = std::clamp(mean - decision, 0.3 * soonest, 0.95 * soonest);
  return {observed < 0.5 ? -drift : drift, std::log(boundary), rest};
}

/// Covariance of the estimates: the inverse of the likelihood's curvature; nothing if it is not
/// positive.
std::optional<Eigen::MatrixXd> diffusion_covariance(const DiffusionLikelihood& likelihood,
                                                    const DiffusionPlace& place) {
  constexpr DiffusionPlace kSteps{1e-3, 5e-4, 1e-4};
  const auto value = [&](std::size_t i, double di, std::size_t k, double dk) {
    DiffusionPlace moved = place;
    moved[i] += di * kSteps[i];
    moved[k] += dk * kSteps[k];
    return likelihood(moved);
  };
  Eigen::MatrixXd curvature(3, 3);
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t k = 0; k < 3; ++k) {
      curvature(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(k)) =
          (value(i, 1, k, 1) - value(i, 1, k, -1) - value(i, -1, k, 1) + value(i, -1, k, -1)) /
          (4.0 * kSteps[i] * kSteps[k]);
    }
  }
  return curvature.allFinite() ? solve_positive(curvature, Eigen::MatrixXd::Identity(3, 3))
                               : std::nullopt;
}

/// The fit with the covariance that says how far to look for the ends of intervals.
struct FittedDiffusion {
  const DiffusionLikelihood& likelihood;
  DiffusionPlace place;
  double value;  // minus the logarithm of the likelihood
  Eigen::MatrixXd covariance;

  double error(std::size_t i) const {
    const auto at = static_cast<Eigen::Index>(i);
    return std::sqrt(covariance(at, at));
  }
};

/// Minus the logarithm of the likelihood with one parameter held and the others fitted anew.
double diffusion_profile(const FittedDiffusion& fitted, std::size_t held, double value) {
  const std::array<std::size_t, 2> free{held == 0 ? 1U : 0U, held == 2 ? 1U : 2U};
  std::array<double, 2> start, steps;
  for (std::size_t k = 0; k < 2; ++k) {
    const auto i = static_cast<Eigen::Index>(held), f = static_cast<Eigen::Index>(free[k]);
    const double lean = fitted.covariance(f, i) / fitted.covariance(i, i);
    start[k] = fitted.place[free[k]] + lean * (value - fitted.place[held]);
    steps[k] = 0.2 * fitted.error(free[k]);
  }
  const auto of_free = [&](std::span<const double> others) {
    DiffusionPlace place;
    place[held] = value;
    place[free[0]] = others[0];
    place[free[1]] = others[1];
    return fitted.likelihood(place);
  };
  return find_minimum(of_free, start, steps, 0.05).value;
}

/// An end of the interval by profile likelihood. The root of twice the loss of likelihood grows
/// nearly in proportion to the distance from the fit.
double interval_end(const FittedDiffusion& fitted, std::size_t held, double side) {
  constexpr int kSteps = 12;
  const double wide = normal_quantile(0.975), middle = fitted.place[held];
  double distance = side * wide * fitted.error(held);
  for (int step = 0; step < kSteps; ++step) {
    if (held == 2 && middle + distance < 0.0) {
      distance = -middle;
    }
    const double loss = diffusion_profile(fitted, held, middle + distance) - fitted.value;
    const double root = std::sqrt(2.0 * std::max(loss, 1e-6));
    if (std::abs(root - wide) < 0.01 || (root < wide && held == 2 && distance == -middle)) {
      break;
    }
    distance *= std::clamp(wide / root, 0.5, 1.5);
  }
  return middle + distance;
}

DiffusionEstimate estimate_of(const FittedDiffusion& fitted, std::size_t i) {
  return {fitted.place[i], interval_end(fitted, i, -1.0), interval_end(fitted, i, 1.0)};
}

/// FittedDiffusion probability of an answer at or before each time of a grid.
std::vector<double> distribution(const Diffusion& model, bool upper, double step,
                                 std::size_t count) {
  std::vector<double> sums(count + 1, 0.0);
  double last = 0.0;
  for (std::size_t i = 1; i <= count; ++i) {
    const double here =
        diffusion_density(model, upper, model.non_decision + static_cast<double>(i) * step);
    sums[i] = sums[i - 1] + 0.5 * step * (last + here);
    last = here;
  }
  return sums;
}

double distance_between(std::span<const TimedChoice> choices, const Diffusion& model,
                        double contaminants) {
  constexpr std::size_t kGrid = 2000;
  const double longest = std::ranges::max(choices, {}, &TimedChoice::time).time;
  const double step = std::max(longest - model.non_decision, 1e-6) / kGrid;
  const std::array<std::vector<double>, 2> sums{distribution(model, false, step, kGrid),
                                                distribution(model, true, step, kGrid)};
  const double lower = 1.0 - diffusion_share(model);
  const auto fitted = [&](double signed_time) {
    const double time = std::abs(signed_time);
    const double at = std::max(time - model.non_decision, 0.0) / step;
    const double before = sums[signed_time > 0.0 ? 1 : 0][static_cast<std::size_t>(at + 0.5)];
    const double even = 0.5 * (1.0 + signed_time / longest);
    return (1.0 - contaminants) * (signed_time > 0.0 ? lower + before : lower - before) +
           contaminants * even;
  };
  std::vector<double> times;
  for (const TimedChoice& each : choices) {
    times.push_back(each.upper ? each.time : -each.time);
  }
  std::ranges::sort(times);
  double distance = 0.0;
  for (std::size_t i = 0; i < times.size(); ++i) {
    const auto n = static_cast<double>(times.size());
    const double f = fitted(times[i]), below = static_cast<double>(i) / n;
    distance = std::max({distance, std::abs(f - below), std::abs(f - below - 1.0 / n)});
  }
  return distance;
}

/// Why the answers do not allow a fit; empty: they do.
std::string problem_with_choices(std::span<const TimedChoice> choices, std::size_t rarer) {
  if (choices.size() < kFewestTimedChoices) {
    return fmt::format("there are {} answers with a time, fewer than {}", choices.size(),
                       kFewestTimedChoices);
  }
  if (rarer == 0) {
    return "all answers are of one kind";
  }
  const bool positive = std::ranges::all_of(
      choices, [](const TimedChoice& each) { return std::isfinite(each.time) && each.time > 0.0; });
  return positive ? "" : "some time is not above 0";
}

}  // namespace

double diffusion_density(const Diffusion& model, bool upper, double time) noexcept {
  const double t = time - model.non_decision;
  if (!(t > 0.0)) {
    return 0.0;
  }
  const double drift = upper ? -model.drift : model.drift;
  const double start = upper ? 1.0 - model.start : model.start;
  const double squared = model.boundary * model.boundary;
  return std::exp(-drift * model.boundary * start - 0.5 * drift * drift * t) / squared *
         standard_density(t / squared, start);
}

double diffusion_share(const Diffusion& model) noexcept {
  const double end = -2.0 * model.drift * model.boundary;
  return std::abs(end) < 1e-9 ? model.start : std::expm1(end * model.start) / std::expm1(end);
}

Defined<DiffusionFit> fit_diffusion(std::span<const TimedChoice> choices,
                                    const DiffusionOptions& options) {
  if (!(options.start > 0.0 && options.start < 1.0) ||
      !(options.contaminants >= 0.0 && options.contaminants < 1.0)) {
    throw std::invalid_argument("start must lie inside (0, 1) and contaminants in [0, 1)");
  }
  const auto uppers = static_cast<std::size_t>(std::ranges::count_if(choices, &TimedChoice::upper));
  const std::size_t rarer = std::min(uppers, choices.size() - uppers);
  if (const std::string problem = problem_with_choices(choices, rarer); !problem.empty()) {
    return Undefined{problem};
  }
  const DiffusionLikelihood likelihood(choices, options);
  const DiffusionPlace guess = closed_form(choices, uppers);
  const DiffusionPlace steps{0.2, 0.1, -0.1 * guess[2]};
  const Minimum best = find_minimum(std::cref(likelihood), guess, steps, 1e-5);
  const DiffusionPlace place{best.at[0], best.at[1], best.at[2]};
  const auto covariance = diffusion_covariance(likelihood, place);
  constexpr double kMostError = 0.5;  // of the boundary's logarithm: a factor of 2.7 on each side
  if (!covariance || !((*covariance)(1, 1) < kMostError * kMostError)) {
    return Undefined{"answers and times do not determine the parameters"};
  }
  const FittedDiffusion fitted{likelihood, place, best.value, *covariance};
  const DiffusionEstimate log_boundary = estimate_of(fitted, 1);
  DiffusionFit fit;
  fit.drift = estimate_of(fitted, 0);
  fit.boundary = {std::exp(log_boundary.value), std::exp(log_boundary.low),
                  std::exp(log_boundary.high)};
  fit.non_decision = estimate_of(fitted, 2);
  fit.log_likelihood = -best.value;
  fit.trials = choices.size();
  fit.rarer = rarer;
  fit.distance = distance_between(choices, model_at(place, options.start), options.contaminants);
  return fit;
}

}  // namespace haptrial::analysis
