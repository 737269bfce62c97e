#include "analysis/psychometric/fit/likelihood_fit.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>

#include "analysis/psychometric/fit/prior.h"

namespace haptrial::analysis {
namespace {

// Threshold, log width, lapse, guess.
constexpr int kPlaces = 4;
using Place = std::array<double, kPlaces>;
using Square = std::array<Place, kPlaces>;

constexpr double kTiny = 1e-150;  // of a share that is divided by

/// What Newton's method needs of the logarithm of the likelihood at a place.
struct Climb {
  bool possible{true};  // the likelihood is not 0
  Place slope{};
  Square hessian{};  // of minus the logarithm; or Fisher's information
  bool fisher{false};
};

/// How a block's likelihood changes with its p: slope, and minus the curvature.
struct Pull {
  double slope, curvature;
};

/// Sums over the blocks of what makes a Climb, in terms of z - q = rise (x - threshold).
struct Sums {
  double density{0.0}, far{0.0}, lapse{0.0}, guess{0.0};  // slopes
  double bent{0.0}, bent_far{0.0}, bent_far_far{0.0};
  double lapse_near{0.0}, lapse_far{0.0}, guess_near{0.0}, guess_far{0.0};
  double lapse_lapse{0.0}, lapse_guess{0.0}, guess_guess{0.0};

  /// @param from  z - q   @param tied  whether the guess rate is the lapse rate
  void add(const Pull& pull, const SigmoidPoint& s, double between, double from, bool tied,
           bool fisher) noexcept {
    const double f = between * s.density;
    const double by_lapse = tied ? s.beyond - s.share : -s.share;
    const double by_guess = tied ? 0.0 : s.beyond;
    const double second = fisher ? 0.0 : pull.slope;  // times second derivatives of p
    const double e = pull.curvature * f * f - second * between * s.bend;
    const double with_lapse =
        pull.curvature * f * by_lapse + second * s.density * (tied ? 2.0 : 1.0);
    const double with_guess = tied ? 0.0 : pull.curvature * f * by_guess + second * s.density;
    density += pull.slope * f, far += pull.slope * f * from;
    lapse += pull.slope * by_lapse, guess += pull.slope * by_guess;
    bent += e, bent_far += e * from, bent_far_far += e * from * from;
    lapse_near += with_lapse, lapse_far += with_lapse * from;
    guess_near += with_guess, guess_far += with_guess * from;
    lapse_lapse += pull.curvature * by_lapse * by_lapse;
    lapse_guess += pull.curvature * by_lapse * by_guess;
    guess_guess += pull.curvature * by_guess * by_guess;
  }

  /// dz = -rise d threshold - (z - q) d log width
  void put(Climb& climb, double rise) const noexcept {
    const double near = climb.fisher ? 0.0 : density, distant = climb.fisher ? 0.0 : far;
    climb.slope = {-rise * density, -far, lapse, guess};
    climb.hessian[0] = {rise * rise * bent};
    climb.hessian[1] = {rise * (bent_far - near), bent_far_far - distant};
    climb.hessian[2] = {-rise * lapse_near, -lapse_far, lapse_lapse};
    climb.hessian[3] = {-rise * guess_near, -guess_far, lapse_guess, guess_guess};
  }
};

/// Solves matrix x = right for the free rows by L D L'; false unless it is positive definite.
bool solved(const Square& matrix, const std::array<bool, kPlaces>& free, const Place& right,
            Place& x) noexcept {
  Square lower{};
  Place pivot{}, y{};
  for (int i = 0; i < kPlaces; ++i) {
    if (!free[i]) {
      continue;
    }
    double d = matrix[i][i];
    y[i] = right[i];
    for (int j = 0; j < i; ++j) {
      if (!free[j]) {
        continue;
      }
      double sum = matrix[i][j];
      for (int k = 0; k < j; ++k) {
        sum -= free[k] ? lower[i][k] * lower[j][k] * pivot[k] : 0.0;
      }
      lower[i][j] = sum / pivot[j];
      d -= lower[i][j] * sum;
      y[i] -= lower[i][j] * y[j];
    }
    if (!(d > 1e-12 * std::abs(matrix[i][i]))) {
      return false;
    }
    pivot[i] = d;
  }
  for (int i = kPlaces; i-- > 0;) {
    x[i] = free[i] ? y[i] / pivot[i] : 0.0;
    for (int k = i + 1; free[i] && k < kPlaces; ++k) {
      x[i] -= free[k] ? lower[k][i] * x[k] : 0.0;
    }
  }
  return true;
}

void check_rate(const RateBounds& bounds, const char* name) {
  if (!(bounds.low >= 0.0 && bounds.high >= bounds.low && bounds.high < 0.5)) {
    throw std::invalid_argument(std::string("bounds of the ") + name +
                                " rate must have 0 <= low <= high < 0.5");
  }
}

/// A step along each free parameter as if it were the only one, from Fisher's information.
Place alone(const Climb& climb, const std::array<bool, kPlaces>& free) noexcept {
  Place change{};
  for (int i = 0; i < kPlaces; ++i) {
    change[i] = free[i] ? climb.slope[i] / std::max(climb.hessian[i][i], 1e-12) : 0.0;
  }
  return change;
}

/// What a step gains where the likelihood is a parabola.
double promised(const Climb& climb, const Place& change) noexcept {
  double sum = 0.0;
  for (int i = 0; i < kPlaces; ++i) {
    sum += 0.5 * change[i] * climb.slope[i];
  }
  return sum;
}

double logit(double share) noexcept { return std::log(share / (1.0 - share)); }

}  // namespace

/// One search: the answers, and the bounds of the place.
struct LikelihoodFitter::Search {
  std::span<const int> correct;
  std::size_t without{std::numeric_limits<std::size_t>::max()};
  bool right{false};  // what is left out
  Place low{}, high{};

  double answers(std::size_t i) const noexcept {
    return correct[i] - (i == without && right ? 1.0 : 0.0);
  }
  double trials(std::size_t i, int total) const noexcept {
    return total - (i == without ? 1.0 : 0.0);
  }

  void clamp(Place& place) const noexcept {
    for (int i = 0; i < kPlaces; ++i) {
      place[i] = std::clamp(place[i], low[i], high[i]);
    }
  }

  /// Whether a parameter may move uphill.
  std::array<bool, kPlaces> free(const Place& place, const Place& slope) const noexcept {
    std::array<bool, kPlaces> result;
    for (int i = 0; i < kPlaces; ++i) {
      result[i] = low[i] < high[i] && (place[i] > low[i] || slope[i] > 0.0) &&
                  (place[i] < high[i] || slope[i] < 0.0);
    }
    return result;
  }

  Place start(const LikelihoodFitter& fitter) const noexcept;
  void at(const LikelihoodFitter& fitter, const Place& place, Climb& climb) const noexcept;
  double value(const LikelihoodFitter& fitter, const Place& place) const noexcept;
  Place next_change(const LikelihoodFitter& fitter, const Place& place,
                    const Climb& climb) const noexcept;
  bool told(const LikelihoodFitter& fitter, const Place& place, const Climb& climb) const noexcept;
  bool step(const LikelihoodFitter& fitter, Place& place, Climb& climb,
            const Place& change) const noexcept;
};

/// A line through the logits of the observed shares, free of guesses and lapses.
Place LikelihoodFitter::Search::start(const LikelihoodFitter& fitter) const noexcept {
  const Sigmoid& sigmoid = fitter.sigmoid_;
  const double lapse = std::min(high[2], low[2] + 0.01);
  const double guess =
      fitter.task_ == Task::kEqualAsymptote ? lapse : std::min(high[3], low[3] + 0.01);
  const double middle = logit(sigmoid.shape().threshold_share);
  const double spread = 2.0 * logit(1.0 - sigmoid.shape().width_tail);
  double sum = 0.0, sum_x = 0.0, sum_y = 0.0, sum_xx = 0.0, sum_xy = 0.0;
  const double origin = 0.5 * (fitter.low_ + fitter.high_);
  for (std::size_t i = 0; i < correct.size(); ++i) {
    const double n = trials(i, fitter.totals_[i]);
    const double observed = (answers(i) + 0.5) / (n + 1.0);
    const double share = std::clamp((observed - guess) / (1.0 - guess - lapse), 0.02, 0.98);
    const double weight = n * share * (1.0 - share), x = fitter.coordinates_[i] - origin;
    const double y = logit(share) - middle;
    sum += weight, sum_x += weight * x, sum_y += weight * y;
    sum_xx += weight * x * x, sum_xy += weight * x * y;
  }
  const double range = fitter.high_ - fitter.low_;
  double slope = (sum * sum_xy - sum_x * sum_y) / (sum * sum_xx - sum_x * sum_x);
  slope = (sigmoid.shape().falling ? -1.0 : 1.0) * slope;
  const double width = slope > 0.0 ? std::clamp(spread / slope, 0.05 * range, 3.0 * range) : range;
  const double rise = (sigmoid.shape().falling ? -1.0 : 1.0) * spread / width;
  Place place{origin + (sum_x - sum_y / rise) / sum, std::log(width), lapse, guess};
  place[0] = std::clamp(place[0], fitter.low_, fitter.high_);
  clamp(place);
  return place;
}

void LikelihoodFitter::Search::at(const LikelihoodFitter& fitter, const Place& place,
                                  Climb& climb) const noexcept {
  const Sigmoid& sigmoid = fitter.sigmoid_;
  const bool tied = fitter.task_ == Task::kEqualAsymptote;
  const double lapse = place[2], guess = tied ? lapse : place[3];
  const double between = 1.0 - guess - lapse;
  const double rise = sigmoid.spread() * std::exp(-place[1]);
  Sums sums;
  for (std::size_t i = 0; i < correct.size(); ++i) {
    const double from = rise * (fitter.coordinates_[i] - place[0]);
    const SigmoidPoint s = sigmoid.at(sigmoid.centre() + from);
    const double p = guess + between * s.share, q = lapse + between * s.beyond;
    const double k = answers(i), m = trials(i, fitter.totals_[i]) - k;
    climb.possible = climb.possible && (k == 0.0 || p > 0.0) && (m == 0.0 || q > 0.0);
    const double by_p = 1.0 / std::max(p, kTiny), by_q = 1.0 / std::max(q, kTiny);
    const double up = k * by_p, down = m * by_q;
    const double curvature = climb.fisher ? (k + m) * by_p * by_q : up * by_p + down * by_q;
    sums.add({up - down, curvature}, s, between, from, tied, climb.fisher);
  }
  sums.put(climb, rise);
}

/// The logarithm of the likelihood, without binomial coefficients.
double LikelihoodFitter::Search::value(const LikelihoodFitter& fitter,
                                       const Place& place) const noexcept {
  const double lapse = place[2];
  const double guess = fitter.task_ == Task::kEqualAsymptote ? lapse : place[3];
  const double width = std::exp(place[1]);
  double sum = 0.0;
  for (std::size_t i = 0; i < correct.size(); ++i) {
    double beyond = 0.0;
    const double share = fitter.sigmoid_.share(fitter.coordinates_[i], place[0], width, beyond);
    const double k = answers(i), m = trials(i, fitter.totals_[i]) - k;
    sum += k > 0.0 ? k * std::log(guess + (1.0 - guess - lapse) * share) : 0.0;
    sum += m > 0.0 ? m * std::log(lapse + (1.0 - guess - lapse) * beyond) : 0.0;
  }
  return sum;
}

/// Goes the step or as much of it as leads uphill. False where nothing does. A step that leaves at
/// most half of the slope along itself needs no value of the likelihood, which takes longest.
bool LikelihoodFitter::Search::step(const LikelihoodFitter& fitter, Place& place, Climb& climb,
                                    const Place& change) const noexcept {
  constexpr int kHalvings = 30;
  double part = 1.0;
  for (int i = 0; i < kHalvings; ++i, part *= 0.5) {
    Place next = place;
    for (int k = 0; k < kPlaces; ++k) {
      next[k] += part * change[k];
    }
    clamp(next);
    Climb there;
    at(fitter, next, there);
    double before = 0.0, after = 0.0;
    for (int k = 0; k < kPlaces; ++k) {
      before += climb.slope[k] * (next[k] - place[k]);
      after += there.slope[k] * (next[k] - place[k]);
    }
    const bool flatter = std::abs(after) <= 0.5 * before;
    if (there.possible && (flatter || value(fitter, next) > value(fitter, place))) {
      place = next;
      climb = there;
      return true;
    }
  }
  return false;
}

LikelihoodFitter::LikelihoodFitter(const LikelihoodOptions& options,
                                   std::span<const TrialBlock> blocks)
    : sigmoid_(options.shape), task_(options.task), lapse_(options.lapse), guess_(options.guess) {
  check_rate(options.lapse, "lapse");
  pooled(blocks);  // checks them
  if (task_ == Task::kForcedChoice) {
    if (options.alternatives < 2) {
      throw std::invalid_argument("alternatives must be at least 2");
    }
    guess_ = {1.0 / options.alternatives, 1.0 / options.alternatives};
  } else if (task_ == Task::kEqualAsymptote) {
    guess_ = {0.0, 0.0};
  } else {
    check_rate(options.guess, "guess");
  }
  coordinates_ = coordinates(sigmoid_, blocks);
  const StimulusRange range = stimulus_range(coordinates_);
  low_ = range.low, high_ = range.high, spacing_ = range.spacing;
  for (const TrialBlock& block : blocks) {
    totals_.push_back(block.total);
  }
}

int LikelihoodFitter::free_parameters() const noexcept {
  return 2 + (lapse_.low < lapse_.high ? 1 : 0) + (guess_.low < guess_.high ? 1 : 0);
}

/// The next change of the place: Newton's, or where the likelihood is not concave, by Fisher's
/// information. No parameter goes far at once, as a steep function has maxima of its own.
Place LikelihoodFitter::Search::next_change(const LikelihoodFitter& fitter, const Place& place,
                                            const Climb& climb) const noexcept {
  const auto movable = free(place, climb.slope);
  Place change{};
  if (!solved(climb.hessian, movable, climb.slope, change)) {
    Climb expected;
    expected.fisher = true;
    at(fitter, place, expected);
    if (!solved(expected.hessian, movable, climb.slope, change)) {
      change = alone(expected, movable);
    }
  }
  const Place most{0.25 * (fitter.high_ - fitter.low_), 0.7, 1.0, 1.0};
  double part = 1.0;
  for (int i = 0; i < kPlaces; ++i) {
    part = std::abs(change[i]) > most[i] ? std::min(part, most[i] / std::abs(change[i])) : part;
  }
  for (double& c : change) {
    c *= part;
  }
  return change;
}

/// Whether the answers tell threshold and width at all.
bool LikelihoodFitter::Search::told(const LikelihoodFitter& fitter, const Place& place,
                                    const Climb& climb) const noexcept {
  const double range = fitter.high_ - fitter.low_;
  // At best, standard errors of the range and of a factor 20.
  bool inside = climb.hessian[0][0] * range * range > 1.0 && climb.hessian[1][1] > 1.0 / 9.0;
  for (int i = 0; i < 2; ++i) {
    inside = inside && place[i] > low[i] && place[i] < high[i];
  }
  return inside;
}

LikelihoodFit LikelihoodFitter::search(Search& search) const noexcept {
  constexpr int kMost = 200;
  constexpr double kDone = 1e-8;  // of the logarithm; a Newton step squares what is left
  const double range = high_ - low_;
  search.low = {low_ - range, std::log(spacing_), lapse_.low, guess_.low};
  search.high = {high_ + range, std::log(20.0 * range), lapse_.high, guess_.high};
  LikelihoodFit fit;
  Place place = search.start(*this);
  Climb climb;
  search.at(*this, place, climb);
  for (; fit.steps < kMost; ++fit.steps) {
    Place change = search.next_change(*this, place, climb);
    const double promise = promised(climb, change);
    if (promise < kDone) {
      for (int i = 0; i < kPlaces; ++i) {
        place[i] += change[i];
      }
      search.clamp(place);
      fit.converged = true;
      break;
    }
    if (!search.step(*this, place, climb, change)) {
      // A bound bends Newton's direction downhill: each parameter by itself still leads up.
      Climb expected;
      expected.fisher = true;
      search.at(*this, place, expected);
      change = alone(expected, search.free(place, climb.slope));
      if (!search.step(*this, place, climb, change)) {
        break;
      }
    }
  }
  fit.parameters = {place[0], std::exp(place[1]), place[2],
                    task_ == Task::kEqualAsymptote ? place[2] : place[3], 0.0};
  fit.log_likelihood = search.value(*this, place);
  fit.undetermined = !search.told(*this, place, climb);
  return fit;
}

LikelihoodFit LikelihoodFitter::fit(std::span<const int> correct) const noexcept {
  Search one{correct};
  return search(one);
}

LikelihoodFit LikelihoodFitter::fit_without(std::span<const int> correct, std::size_t block,
                                            bool right) const noexcept {
  Search one{correct, block, right};
  return search(one);
}

LikelihoodFit likelihood_fit(std::span<const TrialBlock> blocks, const LikelihoodOptions& options) {
  const LikelihoodFitter fitter(options, blocks);
  std::vector<int> correct;
  for (const TrialBlock& block : blocks) {
    correct.push_back(block.correct);
  }
  return fitter.fit(correct);
}

}  // namespace haptrial::analysis
