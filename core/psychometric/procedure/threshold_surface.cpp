#include "core/psychometric/procedure/threshold_surface.h"

#include <fmt/format.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>

#include "core/base/random.h"
#include "core/psychometric/function/sigmoid.h"

namespace haptrial::psychometric {
namespace {

constexpr const char* kSurface = "ThresholdSurface";
constexpr std::array kSlopes{1.5, 4.0, 10.0};
constexpr std::array kBends{0.25, 1.0, 1.0};
constexpr std::array kLengths{1.2, 1.2, 0.7};  // of each bend
constexpr double kSteep = 20.0;                // of a link that is a step nearly
constexpr std::size_t kPresented = 1000;       // of the levels that are listed
constexpr std::size_t kJudged = 160;           // levels by which a choice is judged
constexpr std::size_t kCompared = 40;          // levels of which one is chosen
constexpr std::size_t kPlaces = 65;            // along a line on which a threshold is sought
constexpr double kDraws = 2000.0;
constexpr double kUnlikely = 0.02;  // weight of a belief that is left out of choices

std::vector<double> multiples(std::size_t count) {
  std::vector<double> places(count);
  for (std::size_t i = 0; i < count; ++i) {
    places[i] = -1.0 + 2.0 * static_cast<double>(i) / static_cast<double>(count - 1);
  }
  return places;
}

/// All combinations of one choice a list.
std::vector<std::vector<double>> combined(const std::vector<std::vector<double>>& lists) {
  std::vector<std::vector<double>> all{{}};
  for (const auto& list : lists) {
    std::vector<std::vector<double>> longer;
    for (const auto& each : all) {
      for (const double value : list) {
        longer.push_back(each);
        longer.back().push_back(value);
      }
    }
    all = std::move(longer);
  }
  return all;
}

/// At most `most` values of a list, evenly taken, its ends among them.
std::vector<double> thinned(const std::vector<double>& list, std::size_t most) {
  if (list.size() <= most) {
    return list;
  }
  std::vector<double> some;
  for (std::size_t i = 0; i < most; ++i) {
    some.push_back(list[(i * (list.size() - 1) + (most - 1) / 2) / (most - 1)]);
  }
  return some;
}

/// All places of a long list, or `most` of them by chance, the same always.
std::vector<Eigen::Index> some_of(std::size_t count, std::size_t most, const char* stream) {
  std::vector<Eigen::Index> places(count);
  std::iota(places.begin(), places.end(), Eigen::Index{0});
  if (count > most) {
    RandomStream random(0, stream);
    for (std::size_t i = 0; i < most; ++i) {
      std::swap(places[i], places[i + random.below(count - i)]);
    }
    places.resize(most);
  }
  return places;
}

void check(const SurfaceParameters& p) {
  checks::require(!p.variables.empty() && p.variables.size() <= 4, kSurface,
                  "variables must be 1 to 4");
  for (const SurfaceVariable& each : p.variables) {
    checks::require(
        each.levels.size() >= 2 &&
            std::ranges::adjacent_find(each.levels, std::greater_equal<>()) == each.levels.end(),
        kSurface, "levels of " + each.name + " must be 2 or more that rise");
  }
  checks::require(p.guess >= 0.0 && p.lapse >= 0.0 && p.guess + p.lapse < 1.0, kSurface,
                  "guess and lapse must be at least 0 and their sum below 1");
  checks::require(p.target > p.guess && p.target < 1.0 - p.lapse, kSurface,
                  "target must be above guess and below 1 - lapse");
  checks::require(p.trials >= 1, kSurface, "trials must be 1 or more");
}

/// With the target that is meant.
SurfaceParameters meant(SurfaceParameters p) {
  p.target = p.target == 0.0 ? 0.5 * (1.0 + p.guess - p.lapse) : p.target;
  check(p);
  return p;
}

double f_at(const SurfaceParameters& p) {
  return sigmoid_quantile(Sigmoid::kGaussian, (p.target - p.guess) / (1.0 - p.guess - p.lapse));
}

/// p (1 - p) for the probability p that a normal f is above the target, a logistic function nearly.
/// It only ranks levels, and is the same on every machine.
Eigen::ArrayXd unsure(const Eigen::ArrayXd& mean, const Eigen::ArrayXd& variance, double target) {
  constexpr double kLogistic = 1.702, kLeast = 1e-12;
  const Eigen::ArrayXd odds =
      (-kLogistic * (mean - target).abs() / variance.max(kLeast).sqrt()).exp();
  return odds / (1.0 + odds).square();
}

}  // namespace

ThresholdSurface::ThresholdSurface(const SurfaceParameters& parameters)
    : parameters_(meant(parameters)),
      basis_(parameters.variables.size()),
      at_target_(f_at(parameters_)) {
  list_levels();
  begin_beliefs();
  choose();
}

void ThresholdSurface::list_levels() {
  std::vector<std::vector<double>> lists;
  for (const SurfaceVariable& each : parameters_.variables) {
    lists.push_back(each.levels);
  }
  levels_ = combined(lists);
  if (parameters_.allowed) {
    std::erase_if(levels_, [&](const Level& level) { return !parameters_.allowed(level); });
  }
  checks::require(levels_.size() >= 2, kSurface, "allowed must leave two levels or more");
  std::vector<Level> presented;
  for (const Eigen::Index i : some_of(levels_.size(), kPresented, "levels that are presented")) {
    presented.push_back(std::move(levels_[static_cast<std::size_t>(i)]));
  }
  levels_ = std::move(presented);
  rows_.resize(static_cast<Eigen::Index>(levels_.size()), basis_.size());
  for (std::size_t i = 0; i < levels_.size(); ++i) {
    rows_.row(static_cast<Eigen::Index>(i)) = basis_.at(place_of(levels_[i])).transpose();
  }
  judged_ = some_of(levels_.size(), kJudged, "levels by which choices are judged");
  judged_rows_ = rows_(judged_, Eigen::all);
}

void ThresholdSurface::begin_beliefs() {
  const std::size_t d = basis_.dimensions();
  const auto grid = combined(std::vector(d, multiples(d <= 2 ? 5 : d == 3 ? 4 : 3)));
  for (std::size_t k = 0; k < d; ++k) {
    for (std::size_t i = 0; (k == 0 || parameters_.variables[k].rises) && i < grid.size(); ++i) {
      rises_.push_back(kSteep * basis_.slope(grid[i], k));
    }
  }
  for (const double slope : kSlopes) {
    for (std::size_t b = 0; b < kBends.size(); ++b) {
      const Smoothness smoothness{slope, kBends[b], kLengths[b]};
      Candidate candidate{SmoothBelief(basis_.deviations(smoothness)), 0.0, 1.0, {}, {}};
      for (int round = 0; round < 2; ++round) {
        for (std::size_t i = 0; i < rises_.size(); ++i) {
          candidate.belief.visit(i, rises_[i], {});
        }
      }
      candidate.mean = rows_ * candidate.belief.mean();
      candidate.variance =
          (rows_ * candidate.belief.covariance()).cwiseProduct(rows_).rowwise().sum();
      candidates_.push_back(std::move(candidate));
    }
  }
  weigh();
}

/// Numbers from -1 to 1, by the places of the levels in their lists.
std::vector<double> ThresholdSurface::place_of(const Level& level) const {
  std::vector<double> place(level.size());
  for (std::size_t k = 0; k < level.size(); ++k) {
    const auto& list = parameters_.variables[k].levels;
    const double x = std::clamp(level[k], list.front(), list.back());
    const auto above = std::ranges::upper_bound(list, x);
    const auto i = static_cast<std::size_t>(std::clamp<std::ptrdiff_t>(
        above - list.begin(), 1, static_cast<std::ptrdiff_t>(list.size()) - 1));
    const double at = static_cast<double>(i - 1) + (x - list[i - 1]) / (list[i] - list[i - 1]);
    place[k] = -1.0 + 2.0 * at / static_cast<double>(list.size() - 1);
  }
  return place;
}

ProbitLink ThresholdSurface::link_of(bool answer) const noexcept {
  const double share = 1.0 - parameters_.guess - parameters_.lapse;
  return answer ? ProbitLink{parameters_.guess, share, 1.0}
                : ProbitLink{parameters_.lapse, share, -1.0};
}

void ThresholdSurface::weigh() {
  const double best = std::ranges::max_element(candidates_, {}, &Candidate::evidence)->evidence;
  double sum = 0.0;
  for (Candidate& each : candidates_) {
    each.weight = std::exp(each.evidence - best);
    sum += each.weight;
  }
  for (Candidate& each : candidates_) {
    each.weight /= sum;
  }
}

const Level& ThresholdSurface::next() const {
  checks::require_running(!finished(), kSurface);
  return next_;
}

void ThresholdSurface::report(double answer, const Level& applied) {
  checks::require_running(!finished(), kSurface);
  const bool yes = checks::outcome_of(answer, 2, kSurface) == 1;
  checks::require(applied.size() == next_.size() &&
                      std::ranges::all_of(applied, [](double x) { return std::isfinite(x); }),
                  kSurface, "applied must have a finite number for each variable");
  shown_.push_back(basis_.at(place_of(applied)));
  answers_.push_back(yes);
  const std::size_t fact = rises_.size() + shown_.size() - 1;
  for (Candidate& each : candidates_) {
    const auto visit = each.belief.visit(fact, shown_.back(), link_of(yes));
    each.evidence += std::log(visit.probability);
    const Eigen::VectorXd reach = each.belief.covariance() * shown_.back();
    each.mean = rows_ * each.belief.mean();
    each.variance -= visit.lost * (rows_ * reach).cwiseAbs2();
  }
  ++trials_;
  weigh();
  if (!finished()) {
    choose();
  }
}

Eigen::VectorXd ThresholdSurface::doubt() const {
  Eigen::VectorXd sum = Eigen::VectorXd::Zero(rows_.rows());
  for (const Candidate& each : candidates_) {
    if (each.weight >= kUnlikely) {
      sum.array() += each.weight * unsure(each.mean, each.variance, at_target_);
    }
  }
  return sum;
}

/// Levels whose side is least sure, spread over many of them.
std::vector<Eigen::Index> ThresholdSurface::doubtful() const {
  const Eigen::VectorXd doubts = doubt();
  std::vector<Eigen::Index> order(levels_.size());
  std::iota(order.begin(), order.end(), Eigen::Index{0});
  std::ranges::stable_sort(order, std::greater<>(), [&](Eigen::Index i) { return doubts[i]; });
  const std::size_t among = std::min(order.size(), std::max(kCompared, order.size() / 3));
  const std::size_t step = std::max<std::size_t>(1, among / kCompared);
  std::vector<Eigen::Index> some;
  for (std::size_t i = 0; i < among; i += step) {
    some.push_back(order[i]);
  }
  return some;
}

/// Expected doubt at the judged levels after an answer to `level`, by one belief.
/// @param shared  (judged) covariances with f at `level`
double ThresholdSurface::doubt_after(const Candidate& by, Eigen::Index level,
                                     const Eigen::ArrayXd& shared) const {
  const Eigen::ArrayXd mean = by.mean(judged_), variance = by.variance(judged_);
  double sum = 0.0;
  for (const bool answer : {false, true}) {
    const ProbitChange change = change_by(link_of(answer), by.mean[level], by.variance[level]);
    sum += change.probability *
           unsure(mean + shared * change.pull, variance - shared.square() * change.bend, at_target_)
               .sum();
  }
  return sum;
}

void ThresholdSurface::choose() {
  const std::vector<Eigen::Index> compared = doubtful();
  const Eigen::MatrixXd rows = rows_(compared, Eigen::all);
  Eigen::VectorXd doubts = Eigen::VectorXd::Zero(rows.rows());
  for (const Candidate& each : candidates_) {
    if (each.weight < kUnlikely) {
      continue;
    }
    const Eigen::MatrixXd shared = judged_rows_ * (each.belief.covariance() * rows.transpose());
    for (Eigen::Index i = 0; i < rows.rows(); ++i) {
      doubts[i] += each.weight *
                   doubt_after(each, compared[static_cast<std::size_t>(i)], shared.col(i).array());
    }
  }
  Eigen::Index least = 0;
  doubts.minCoeff(&least);
  next_ = levels_[static_cast<std::size_t>(compared[static_cast<std::size_t>(least)])];
}

/// The likely beliefs with every fact visited again, so that their order no longer matters.
std::vector<ThresholdSurface::Candidate> ThresholdSurface::refined() const {
  constexpr int kRounds = 5;
  std::vector<Candidate> likely;
  std::ranges::copy_if(candidates_, std::back_inserter(likely),
                       [](const Candidate& each) { return each.weight >= kUnlikely; });
  for (Candidate& each : likely) {
    for (int round = 0; round < kRounds; ++round) {
      for (std::size_t i = 0; i < rises_.size(); ++i) {
        each.belief.visit(i, rises_[i], {});
      }
      for (std::size_t i = 0; i < shown_.size(); ++i) {
        each.belief.visit(rises_.size() + i, shown_[i], link_of(answers_[i]));
      }
    }
  }
  return likely;
}

std::optional<LevelRange> ThresholdSurface::range() const {
  const auto& list = parameters_.variables.front().levels;
  return LevelRange{list.front(), list.back()};
}

/// Levels of the other variables at which thresholds are told: their ends and some between.
std::vector<Level> ThresholdSurface::told_at() const {
  constexpr std::array<std::size_t, 4> kMost{1, 5, 3, 3};
  std::vector<std::vector<double>> lists;
  for (std::size_t k = 1; k < parameters_.variables.size(); ++k) {
    lists.push_back(thinned(parameters_.variables[k].levels, kMost[basis_.dimensions() - 1]));
  }
  return combined(lists);
}

/// Draws of the first variable's threshold at each of `others`, a column each; infinite where f
/// crosses nowhere in the range.
Eigen::MatrixXd ThresholdSurface::drawn_thresholds(const std::vector<Level>& others) const {
  const std::vector<double> places = multiples(kPlaces);
  Eigen::MatrixXd rows(static_cast<Eigen::Index>(others.size() * kPlaces), basis_.size());
  for (std::size_t i = 0; i < others.size(); ++i) {
    Level level{parameters_.variables.front().levels.front()};
    level.insert(level.end(), others[i].begin(), others[i].end());
    std::vector<double> place = place_of(level);
    for (std::size_t j = 0; j < kPlaces; ++j) {
      place.front() = places[j];
      rows.row(static_cast<Eigen::Index>(i * kPlaces + j)) = basis_.at(place).transpose();
    }
  }
  std::vector<Eigen::VectorXd> drawn;
  RandomStream random(0, "threshold surface");
  for (const Candidate& each : refined()) {
    Eigen::MatrixXd covariance = each.belief.covariance();
    covariance.diagonal().array() += 1e-10;
    const Eigen::LLT<Eigen::MatrixXd> root(covariance);
    const auto count = static_cast<int>(std::lround(kDraws * each.weight));
    for (int i = 0; i < count; ++i) {
      const Eigen::VectorXd z = Eigen::VectorXd::NullaryExpr(
          basis_.size(), [&](Eigen::Index) { return random.normal(); });
      drawn.push_back(thresholds_of(rows * (each.belief.mean() + root.matrixL() * z)));
    }
  }
  Eigen::MatrixXd all(static_cast<Eigen::Index>(drawn.size()),
                      static_cast<Eigen::Index>(others.size()));
  for (std::size_t i = 0; i < drawn.size(); ++i) {
    all.row(static_cast<Eigen::Index>(i)) = drawn[i].transpose();
  }
  return all;
}

/// @param f  kPlaces values along the first variable after each other
Eigen::VectorXd ThresholdSurface::thresholds_of(const Eigen::VectorXd& f) const {
  constexpr auto kStretch = static_cast<Eigen::Index>(kPlaces);
  const auto& list = parameters_.variables.front().levels;
  Eigen::VectorXd found(f.size() / kStretch);
  for (Eigen::Index line = 0; line < found.size(); ++line) {
    const auto along = f.segment(line * kStretch, kStretch).array() - at_target_;
    Eigen::Index i = 0;
    while (i < kStretch && along[i] < 0.0) {
      ++i;
    }
    if (i == 0 || i == kStretch) {
      found[line] = (i == 0 ? -1.0 : 1.0) * std::numeric_limits<double>::infinity();
      continue;
    }
    const double at = static_cast<double>(i) - along[i] / (along[i] - along[i - 1]);
    const double place =
        at / static_cast<double>(kStretch - 1) * (static_cast<double>(list.size()) - 1.0);
    const auto below = std::min(static_cast<std::size_t>(place), list.size() - 2);
    found[line] =
        list[below] + (place - static_cast<double>(below)) * (list[below + 1] - list[below]);
  }
  return found;
}

std::string ThresholdSurface::name_of(const Level& others) const {
  std::string name = "threshold of " + parameters_.variables.front().name;
  for (std::size_t k = 0; k < others.size(); ++k) {
    name += fmt::format("{}{} {:.6g}", k == 0 ? " at " : ", ", parameters_.variables[k + 1].name,
                        others[k]);
  }
  return name;
}

std::vector<SurfaceThreshold> ThresholdSurface::thresholds(const std::vector<Level>& others) const {
  const LevelRange levels = *range();
  const Eigen::MatrixXd drawn = drawn_thresholds(others);
  std::vector<SurfaceThreshold> all;
  for (Eigen::Index i = 0; i < drawn.cols(); ++i) {
    std::vector<double> one(static_cast<std::size_t>(drawn.rows()));
    Eigen::VectorXd::Map(one.data(), drawn.rows()) = drawn.col(i);
    std::ranges::sort(one);
    const auto share = [&](double p) {
      return one[static_cast<std::size_t>(p * static_cast<double>(one.size() - 1))];
    };
    all.push_back(
        {share(0.5), std::min(share(0.025), levels.high), std::max(share(0.975), levels.low)});
  }
  return all;
}

std::vector<Estimate> ThresholdSurface::estimates() const {
  if (trials_ == 0) {
    return {};
  }
  const std::vector<Level> others = told_at();
  const std::vector<SurfaceThreshold> found = thresholds(others);
  std::vector<Estimate> all;
  for (std::size_t i = 0; i < others.size(); ++i) {
    Estimate estimate{
        name_of(others[i]), found[i].median, {}, {}, EstimateInterval{found[i].low, found[i].high}};
    if (!std::isfinite(estimate.value)) {
      const LevelRange levels = *range();
      estimate.value = estimate.value < 0.0 ? levels.low : levels.high;
      estimate.remark = "beyond its levels";
    }
    all.push_back(std::move(estimate));
  }
  return all;
}

}  // namespace haptrial::psychometric
