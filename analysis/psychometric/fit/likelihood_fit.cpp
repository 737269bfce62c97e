#include "analysis/psychometric/fit/likelihood_fit.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <stdexcept>
#include <string>

#include "analysis/psychometric/fit/likelihood_climb.h"

namespace haptrial::analysis {
namespace {

using namespace climbing;

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
  if (!(bounds.low >= 0.0 && bounds.high >= bounds.low && bounds.high <= kLargestRate)) {
    throw std::invalid_argument(std::string("bounds of the ") + name +
                                " rate must have 0 <= low <= high <= 0.5");
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

/// Gain of a step if the likelihood is a parabola.
double promised(const Climb& climb, const Place& change) noexcept {
  double sum = 0.0;
  for (int i = 0; i < kPlaces; ++i) {
    sum += 0.5 * change[i] * climb.slope[i];
  }
  return sum;
}

Place place_of(const FittedParameters& p) noexcept {
  return {p.threshold, std::log(p.width), p.lapse, p.guess};
}

double logit(double share) noexcept { return std::log(share / (1.0 - share)); }

}  // namespace

/// One search: the answers, and the bounds of the place.
struct LikelihoodFitter::Search {
  Search(const LikelihoodFitter& fitter, std::span<const int> answers,
         std::size_t block = std::numeric_limits<std::size_t>::max(),
         bool correct_one = false) noexcept
      : correct(answers), without(block), right(correct_one) {
    const SearchBounds threshold = fitter.bounds(Held::kThreshold);
    const SearchBounds width = fitter.bounds(Held::kWidth);
    low = {threshold.low, width.low, fitter.lapse_.low, fitter.guess_.low};
    high = {threshold.high, width.high, fitter.lapse_.high, fitter.guess_.high};
  }

  std::span<const int> correct;
  std::size_t without;  // of which block a trial is left out
  bool right;           // which one
  Place low, high;

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
  Blocks blocks_from(const LikelihoodFitter& fitter, std::size_t first,
                     double elsewhere) const noexcept;
  double value(const LikelihoodFitter& fitter, const Place& place) const noexcept;
  Place next_change(const LikelihoodFitter& fitter, const Place& place,
                    const Climb& climb) const noexcept;
  void add_catches(const LikelihoodFitter& fitter, const Spot& spot, Climb& climb) const noexcept;
  bool told(const LikelihoodFitter& fitter, const Place& place, const Climb& climb) const noexcept;
  bool step(const LikelihoodFitter& fitter, Place& place, Climb& climb,
            const Place& change) const noexcept;
};

/// A line through the logits of the observed shares, free of guesses and lapses.
Place LikelihoodFitter::Search::start(const LikelihoodFitter& fitter) const noexcept {
  const psychometric::PsychometricParameters& shape = fitter.shape_;
  const double lapse = std::min(high[2], low[2] + 0.01);
  const double guess =
      fitter.task_ == Task::kEqualAsymptote ? lapse : std::min(high[3], low[3] + 0.01);
  const double middle = logit(shape.share);
  const double spread = 2.0 * logit(1.0 - shape.tail);
  double sum = 0.0, sum_x = 0.0, sum_y = 0.0, sum_xx = 0.0, sum_xy = 0.0;
  const double origin = 0.5 * (fitter.low_ + fitter.high_);
  for (std::size_t i = 0; i < correct.size(); ++i) {
    if (fitter.coordinates_[i] == kNoStimulus) {
      continue;
    }
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
  slope = (shape.falling ? -1.0 : 1.0) * slope;
  const double width = slope > 0.0 ? std::clamp(spread / slope, 0.05 * range, 3.0 * range) : range;
  const double rise = (shape.falling ? -1.0 : 1.0) * spread / width;
  Place place{origin + (sum_x - sum_y / rise) / sum, std::log(width), lapse, guess};
  place[0] = std::clamp(place[0], fitter.low_, fitter.high_);
  clamp(place);
  return place;
}

void LikelihoodFitter::Search::at(const LikelihoodFitter& fitter, const Place& place,
                                  Climb& climb) const noexcept {
  const bool tied = fitter.task_ == Task::kEqualAsymptote;
  const Spot spot{place[0], fitter.curve_.spread() * std::exp(-place[1]),
                  place[2], tied ? place[2] : place[3],
                  tied,     climb.fisher};
  Sums sums;
  for (std::size_t first = 0; first < correct.size(); first += kLanes) {
    const Blocks blocks = blocks_from(fitter, first, place[0]);
    if (low[3] < high[3]) {
      sums.add<true>(fitter.curve_, blocks, spot);
    } else {
      sums.add<false>(fitter.curve_, blocks, spot);
    }
  }
  sums.put(climb, spot.rise);
  add_catches(fitter, spot, climb);
}

/// Catch trials tell the guess rate alone.
void LikelihoodFitter::Search::add_catches(const LikelihoodFitter& fitter, const Spot& spot,
                                           Climb& climb) const noexcept {
  for (std::size_t i = 0; i < correct.size(); ++i) {
    if (fitter.coordinates_[i] != kNoStimulus) {
      continue;
    }
    const double n = trials(i, fitter.totals_[i]), yes = answers(i), no = n - yes;
    const double p = std::max(spot.guess, 1e-12), q = 1.0 - spot.guess;
    const std::size_t at = spot.tied ? 2 : 3;
    climb.possible = climb.possible && (spot.guess > 0.0 || yes == 0.0);
    climb.slope[at] += yes / p - no / q;
    climb.hessian[at][at] += climb.fisher ? n / (p * q) : yes / (p * p) + no / (q * q);
  }
}

/// @param elsewhere  the place of lanes without answers: beyond the last block, and catch trials
Blocks LikelihoodFitter::Search::blocks_from(const LikelihoodFitter& fitter, std::size_t first,
                                             double elsewhere) const noexcept {
  Blocks blocks;
  const std::size_t count = std::min(kLanes, correct.size() - first);
  for (std::size_t i = 0; i < kLanes; ++i) {
    const bool presented = i < count && fitter.coordinates_[first + i] != kNoStimulus;
    blocks.x[i] = presented ? fitter.coordinates_[first + i] : elsewhere;
    blocks.right[i] = presented ? answers(first + i) : 0.0;
    blocks.wrong[i] =
        presented ? trials(first + i, fitter.totals_[first + i]) - blocks.right[i] : 0.0;
  }
  return blocks;
}

/// The logarithm of the likelihood, without binomial coefficients.
double LikelihoodFitter::Search::value(const LikelihoodFitter& fitter,
                                       const Place& place) const noexcept {
  const double lapse = place[2];
  const double guess = fitter.task_ == Task::kEqualAsymptote ? lapse : place[3];
  const double width = std::exp(place[1]);
  double sum = 0.0;
  for (std::size_t i = 0; i < correct.size(); ++i) {
    const psychometric::SigmoidPoint s = fitter.curve_.at(fitter.coordinates_[i], place[0], width);
    const double k = answers(i), m = trials(i, fitter.totals_[i]) - k;
    sum += k > 0.0 ? k * std::log(guess + (1.0 - guess - lapse) * s.share) : 0.0;
    sum += m > 0.0 ? m * std::log(lapse + (1.0 - guess - lapse) * s.beyond) : 0.0;
  }
  return sum;
}

/// Makes the step, or as much of it as leads uphill. @returns false if nothing does. A step that
/// ends before the top or little behind it needs no value of the likelihood, whose logarithms take
/// long.
bool LikelihoodFitter::Search::step(const LikelihoodFitter& fitter, Place& place, Climb& climb,
                                    const Place& change) const noexcept {
  constexpr int kHalvings = 30;
  double part = 1.0;
  for (int i = 0; i < kHalvings; ++i) {
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
    if (there.possible && before > 0.0 && after >= -0.9 * before) {
      place = next;
      climb = there;
      return true;
    }
    // The factor leads to the top of a parabola.
    part *= there.possible ? std::clamp(before / (before - after), 0.1, 0.7) : 0.5;
  }
  return false;
}

StimulusRange range_of(const LikelihoodOptions& options, std::span<const double> coordinates) {
  StimulusRange range = stimulus_range(coordinates);
  if (options.presentable) {
    range.low = std::min(range.low, options.presentable->low);
    range.high = std::max(range.high, options.presentable->high);
  }
  return range;
}

LikelihoodFitter::LikelihoodFitter(const LikelihoodOptions& options,
                                   std::span<const TrialBlock> blocks)
    : shape_(options.function),
      curve_(psychometric::curve_of(shape_)),
      task_(options.task),
      lapse_(options.lapse),
      guess_(options.guess) {
  check_task(task_, shape_);
  check_rate(options.lapse, "lapse");
  pooled(blocks);  // checks them
  if (task_ == Task::kForcedChoice) {
    guess_ = {shape_.guess, shape_.guess};
  } else if (task_ == Task::kEqualAsymptote) {
    guess_ = {0.0, 0.0};
  } else {
    check_rate(options.guess, "guess");
  }
  coordinates_ = coordinates(shape_.axis, blocks);
  const StimulusRange range = range_of(options, coordinates_);
  low_ = range.low, high_ = range.high, spacing_ = range.spacing;
  for (const TrialBlock& block : blocks) {
    totals_.push_back(block.total);
  }
}

int LikelihoodFitter::trials() const noexcept {
  return std::accumulate(totals_.begin(), totals_.end(), 0);
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
  // The best standard errors are those of the range and of a factor 20.
  bool inside = climb.hessian[0][0] * range * range > 1.0 && climb.hessian[1][1] > 1.0 / 9.0;
  for (int i = 0; i < 2; ++i) {
    inside = inside && place[i] > low[i] && place[i] < high[i];
  }
  return inside;
}

/// Climbs from a place to the next top within the bounds. @param climb  the last one
LikelihoodFit LikelihoodFitter::search(const Search& search, Place place,
                                       Climb& climb) const noexcept {
  constexpr int kMost = 200;
  constexpr double kDone = 1e-8;  // of the logarithm; a Newton step squares what is left
  LikelihoodFit fit;
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
  Climb climb;
  const Search one(*this, correct);
  return search(one, one.start(*this), climb);
}

LikelihoodFit LikelihoodFitter::fit_without(std::span<const int> correct, std::size_t block,
                                            bool right) const noexcept {
  Climb climb;
  const Search one(*this, correct, block, right);
  return search(one, one.start(*this), climb);
}

LikelihoodFit LikelihoodFitter::fit_from(std::span<const int> correct,
                                         const FittedParameters& from) const noexcept {
  const Search one(*this, correct);
  Place place = place_of(from);
  one.clamp(place);
  Climb climb;
  return search(one, place, climb);
}

HeldFit LikelihoodFitter::fit_holding(std::span<const int> correct, Held held, double value,
                                      const FittedParameters& from) const noexcept {
  const std::size_t which = held == Held::kThreshold ? 0 : 1;
  Search one(*this, correct);
  Place place = place_of(from);
  place[which] = value;
  one.clamp(place);
  one.low[which] = one.high[which] = place[which];
  Climb climb;
  LikelihoodFit fit = search(one, place, climb);
  if (!fit.converged) {
    place = one.start(*this);
    fit = search(one, place, climb);
  }
  return {fit.parameters, fit.log_likelihood, climb.slope[which]};
}

SearchBounds LikelihoodFitter::bounds(Held held) const noexcept {
  const double range = high_ - low_;
  return held == Held::kThreshold ? SearchBounds{low_ - range, high_ + range}
                                  : SearchBounds{std::log(spacing_), std::log(20.0 * range)};
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
