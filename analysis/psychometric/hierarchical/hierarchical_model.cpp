#include "analysis/psychometric/hierarchical/hierarchical_model.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "core/base/require.h"

namespace haptrial::analysis::hierarchical {
namespace {

constexpr std::size_t kLanes = psychometric::SigmoidLanes::kCount;
constexpr double kLeast = 1e-300;  // a probability of 0 has no logarithm

// In units of the range of the levels (thresholds), of ln(width / range), and of
// logit(rate / bound).
constexpr FamilyPrior kThresholdPrior{0.0, 1.0, 0.25};
constexpr FamilyPrior kWidthPrior{-0.7, 1.5, 0.5};
constexpr FamilyPrior kLapsePrior{-2.0, 1.0, 0.5};
constexpr FamilyPrior kGuessPrior{-1.0, 1.0, 0.5};

double logistic(double l) noexcept { return 1.0 / (1.0 + std::exp(-l)); }

bool is_free(const RateBounds& bounds) { return bounds.high > bounds.low; }

double rate_of(const RateBounds& bounds, double l) noexcept {
  return is_free(bounds) ? bounds.low + (bounds.high - bounds.low) * logistic(l) : bounds.low;
}

double rate_slope(const RateBounds& bounds, double l) noexcept {
  const double p = logistic(l);
  return (bounds.high - bounds.low) * p * (1.0 - p);
}

Family family_of_rates(const FamilyPrior& prior, std::size_t people) {
  Family family{prior, 1, false, {}, std::vector<std::size_t>(people, 0)};
  for (std::size_t person = 0; person <= people; ++person) {
    family.first.push_back(person);
  }
  return family;
}

void check_order(const std::vector<PersonAnswers>& answers) {
  for (std::size_t i = 0; i < answers.size(); ++i) {
    require(!answers[i].blocks.empty(), "answers must have blocks");
    const std::size_t before = i == 0 ? 0 : answers[i - 1].person;
    const bool same = i > 0 && answers[i].person == before;
    require(same ? answers[i].condition > answers[i - 1].condition
                 : answers[i].person == (i == 0 ? 0 : before + 1),
            "answers must be ordered by person and condition");
  }
}

}  // namespace

Model::Model(std::vector<PersonAnswers> answers, const LikelihoodOptions& options)
    : answers_(std::move(answers)),
      curve_(psychometric::curve_of(options.function)),
      task_(options.task),
      lapse_(options.lapse),
      guess_(options.guess),
      axis_(options.function.axis) {
  check_task(task_, options.function);
  require(lapse_.low >= 0.0 && lapse_.low <= lapse_.high && lapse_.high <= kLargestRate,
          "lapse must have bounds inside [0, 0.5]");
  require(guess_.low >= 0.0 && guess_.low <= guess_.high && guess_.high <= kLargestRate,
          "guess must have bounds inside [0, 0.5]");
  check_order(answers_);
  people_ = answers_.empty() ? 0 : answers_.back().person + 1;
  require(people_ >= 3, "there must be at least three people");
  if (task_ != Task::kYesNo) {
    guess_ = {options.function.guess, options.function.guess};
  }
  for (const PersonAnswers& each : answers_) {
    conditions_ = std::max(conditions_, each.condition + 1);
  }
  set_axis(options);
  set_families();
}

void Model::set_axis(const LikelihoodOptions& options) {
  double low = std::numeric_limits<double>::infinity(), high = -low;
  for (const PersonAnswers& each : answers_) {
    for (const double x : coordinates(options.function.axis, each.blocks)) {
      low = std::isfinite(x) ? std::min(low, x) : low;
      high = std::isfinite(x) ? std::max(high, x) : high;
    }
  }
  require(high > low, "there must be two different levels");
  middle_ = 0.5 * (low + high);
  range_ = high - low;
  for (const PersonAnswers& each : answers_) {
    Series& made = series_.emplace_back();
    const std::vector<double> x = coordinates(options.function.axis, each.blocks);
    for (std::size_t i = 0; i < x.size(); ++i) {
      const double ones = each.blocks[i].correct, zeros = each.blocks[i].total - ones;
      if (!std::isfinite(x[i])) {
        made.catch_ones += ones;
        made.catch_zeros += zeros;
        continue;
      }
      made.x.push_back((x[i] - middle_) / range_);
      made.ones.push_back(ones);
      made.zeros.push_back(zeros);
    }
    const std::size_t filled = (made.x.size() + kLanes - 1) / kLanes * kLanes;
    made.x.resize(filled, 0.0);
    made.ones.resize(filled, 0.0);
    made.zeros.resize(filled, 0.0);
  }
}

void Model::set_families() {
  Family by_condition{kThresholdPrior, conditions_, false, {0}, {}};
  for (const PersonAnswers& each : answers_) {
    if (each.person + 1 > by_condition.first.size()) {
      by_condition.first.push_back(by_condition.column.size());
    }
    by_condition.column.push_back(each.condition);
  }
  by_condition.first.push_back(by_condition.column.size());
  by_condition.within = by_condition.column.size() > people_;
  families_[kThresholds] = by_condition;
  families_[kLogWidths] = by_condition;
  families_[kLogWidths].prior = kWidthPrior;
  families_[kLapses] = family_of_rates(kLapsePrior, is_free(lapse_) ? people_ : 0);
  families_[kGuesses] = family_of_rates(kGuessPrior, is_free(guess_) ? people_ : 0);
}

Model::Rates Model::rates(double lapse, double guess) const noexcept {
  const double l = rate_of(lapse_, lapse);
  return {l, task_ == Task::kEqualAsymptote ? l : rate_of(guess_, guess)};
}

double Model::log_likelihood(std::size_t series, double threshold, double log_width,
                             const Rates& rates) const noexcept {
  const Series& own = series_[series];
  const double steepness = curve_.spread() * std::exp(-log_width);
  const double offset = curve_.centre() - steepness * threshold;
  const double span = 1.0 - rates.lapse - rates.guess;
  psychometric::SigmoidLanes lanes;
  double z[kLanes], sums[kLanes] = {};
  for (std::size_t at = 0; at < own.x.size(); at += kLanes) {
    for (std::size_t i = 0; i < kLanes; ++i) {
      z[i] = offset + steepness * own.x[at + i];
    }
    curve_.at(z, lanes);
    for (std::size_t i = 0; i < kLanes; ++i) {
      const double one = std::max(rates.guess + span * lanes.share[i], kLeast);
      const double zero = std::max(rates.lapse + span * lanes.beyond[i], kLeast);
      sums[i] += (own.ones[at + i] > 0.0 ? own.ones[at + i] * std::log(one) : 0.0) +
                 (own.zeros[at + i] > 0.0 ? own.zeros[at + i] * std::log(zero) : 0.0);
    }
  }
  double sum = 0.0;
  for (const double each : sums) {
    sum += each;
  }
  if (own.catch_ones + own.catch_zeros > 0.0) {
    sum += own.catch_ones * std::log(std::max(rates.guess, kLeast)) +
           own.catch_zeros * std::log1p(-rates.guess);
  }
  return std::isfinite(sum) ? sum : -std::numeric_limits<double>::max();
}

namespace {

using Slopes = std::array<double, kFamilies>;

/// Adds answers of one probability p with its slopes.
void add_answers(double ones, double zeros, double p, double beyond, const Slopes& slopes,
                 Model::Curvature& curvature) noexcept {
  const double one = std::max(p, kLeast), zero = std::max(beyond, kLeast);
  const double slope = ones / one - zeros / zero, weight = (ones + zeros) / (one * zero);
  for (std::size_t a = 0; a < kFamilies; ++a) {
    curvature.slope[a] += slope * slopes[a];
    for (std::size_t b = 0; b < kFamilies; ++b) {
      curvature.information[a][b] += weight * slopes[a] * slopes[b];
    }
  }
}

}  // namespace

Model::Curvature Model::curvature(std::size_t series, double threshold, double log_width,
                                  double lapse, double guess) const noexcept {
  const Series& own = series_[series];
  const Rates r = rates(lapse, guess);
  const bool equal = task_ == Task::kEqualAsymptote;
  const double lapse_slope = is_free(lapse_) ? rate_slope(lapse_, lapse) : 0.0;
  const double guess_slope = is_free(guess_) ? rate_slope(guess_, guess) : 0.0;
  const double steepness = curve_.spread() * std::exp(-log_width);
  const double span = 1.0 - r.lapse - r.guess;
  Curvature made;
  for (std::size_t i = 0; i < own.x.size(); ++i) {
    if (own.ones[i] + own.zeros[i] > 0.0) {
      const double z = curve_.centre() + steepness * (own.x[i] - threshold);
      const psychometric::SigmoidPoint s = curve_.at(z);
      const Slopes slopes{-span * s.density * steepness, -span * s.density * (z - curve_.centre()),
                          (equal ? s.beyond - s.share : -s.share) * lapse_slope,
                          s.beyond * guess_slope};
      add_answers(own.ones[i], own.zeros[i], r.guess + span * s.share, r.lapse + span * s.beyond,
                  slopes, made);
    }
  }
  if (own.catch_ones + own.catch_zeros > 0.0) {
    add_answers(own.catch_ones, own.catch_zeros, r.guess, 1.0 - r.guess,
                {0.0, 0.0, equal ? lapse_slope : 0.0, guess_slope}, made);
  }
  return made;
}

std::vector<double> Model::probabilities(std::size_t series, double threshold, double log_width,
                                         const Rates& rates) const {
  const double steepness = curve_.spread() * std::exp(-log_width);
  std::vector<double> all;
  for (const double x : coordinates(axis_, answers_[series].blocks)) {
    const double z = curve_.centre() + steepness * ((x - middle_) / range_ - threshold);
    const double share = std::isfinite(x) ? curve_.at(z).share : 0.0;
    all.push_back(rates.guess + (1.0 - rates.guess - rates.lapse) * share);
  }
  return all;
}

}  // namespace haptrial::analysis::hierarchical
