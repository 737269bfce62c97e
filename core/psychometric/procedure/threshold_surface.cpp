#include "core/psychometric/procedure/threshold_surface.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "core/base/random.h"

namespace haptrial::psychometric {
namespace {

constexpr const char* kSurface = "ThresholdSurface";
constexpr std::size_t kPresented = 1000;  // of the levels that are listed
constexpr std::size_t kJudged = 160;      // levels by which a choice is judged
constexpr std::size_t kCompared = 40;     // levels of which one is chosen

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

/// p (1 - p) for the probability p that a normal f is above the target, a logistic function nearly.
/// It only ranks levels, and is the same on every machine.
Eigen::ArrayXd unsure(const Eigen::ArrayXd& mean, const Eigen::ArrayXd& variance, double target) {
  constexpr double kLogistic = 1.702, kLeast = 1e-12;
  const Eigen::ArrayXd odds =
      (-kLogistic * (mean - target).abs() / variance.max(kLeast).sqrt()).exp();
  return odds / (1.0 + odds).square();
}

}  // namespace

ThresholdSurface::ThresholdSurface(const SurfaceParameters& parameters) : posterior_(parameters) {
  list_levels();
  foretell();
  choose();
}

void ThresholdSurface::list_levels() {
  std::vector<std::vector<double>> lists;
  for (const SurfaceVariable& each : parameters().variables) {
    lists.push_back(each.levels);
  }
  levels_ = combinations(lists);
  if (parameters().allowed) {
    std::erase_if(levels_, [&](const Level& level) { return !parameters().allowed(level); });
  }
  checks::require(levels_.size() >= 2, kSurface, "allowed must leave two levels or more");
  std::vector<Level> presented;
  for (const Eigen::Index i : some_of(levels_.size(), kPresented, "levels that are presented")) {
    presented.push_back(std::move(levels_[static_cast<std::size_t>(i)]));
  }
  levels_ = std::move(presented);
  rows_.resize(static_cast<Eigen::Index>(levels_.size()), posterior_.terms());
  for (std::size_t i = 0; i < levels_.size(); ++i) {
    rows_.row(static_cast<Eigen::Index>(i)) = posterior_.row_of(levels_[i]).transpose();
  }
  judged_ = some_of(levels_.size(), kJudged, "levels by which choices are judged");
  judged_rows_ = rows_(judged_, Eigen::all);
}

void ThresholdSurface::foretell() {
  for (const auto& each : posterior_.beliefs()) {
    const SmoothBelief& belief = each.of_terms;
    foretold_.push_back(
        {rows_ * belief.mean(), (rows_ * belief.covariance()).cwiseProduct(rows_).rowwise().sum()});
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
  const auto visits = posterior_.report(yes, applied);
  const Eigen::VectorXd row = posterior_.row_of(applied);
  for (std::size_t i = 0; i < visits.size(); ++i) {
    const SmoothBelief& belief = posterior_.beliefs()[i].of_terms;
    foretold_[i].mean = rows_ * belief.mean();
    foretold_[i].variance -= visits[i].lost * (rows_ * (belief.covariance() * row)).cwiseAbs2();
  }
  ++trials_;
  if (!finished()) {
    choose();
  }
}

Eigen::VectorXd ThresholdSurface::doubt() const {
  Eigen::VectorXd sum = Eigen::VectorXd::Zero(rows_.rows());
  for (std::size_t i = 0; i < foretold_.size(); ++i) {
    if (const auto& belief = posterior_.beliefs()[i]; !SurfacePosterior::is_unlikely(belief)) {
      sum.array() +=
          belief.weight * unsure(foretold_[i].mean.array(), foretold_[i].variance.array(),
                                 posterior_.f_at_target());
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
double ThresholdSurface::doubt_after(const PredictedLevels& by, Eigen::Index level,
                                     const Eigen::ArrayXd& shared) const {
  const Eigen::ArrayXd mean = by.mean(judged_), variance = by.variance(judged_);
  double sum = 0.0;
  for (const bool answer : {false, true}) {
    const ProbitChange change =
        change_by(posterior_.link_of(answer), by.mean[level], by.variance[level]);
    sum += change.probability * unsure(mean + shared * change.pull,
                                       variance - shared.square() * change.bend,
                                       posterior_.f_at_target())
                                    .sum();
  }
  return sum;
}

void ThresholdSurface::choose() {
  const std::vector<Eigen::Index> compared = doubtful();
  const Eigen::MatrixXd rows = rows_(compared, Eigen::all);
  Eigen::VectorXd doubts = Eigen::VectorXd::Zero(rows.rows());
  for (std::size_t b = 0; b < foretold_.size(); ++b) {
    const auto& belief = posterior_.beliefs()[b];
    if (SurfacePosterior::is_unlikely(belief)) {
      continue;
    }
    const Eigen::MatrixXd shared = judged_rows_ * (belief.of_terms.covariance() * rows.transpose());
    for (Eigen::Index i = 0; i < rows.rows(); ++i) {
      doubts[i] += belief.weight * doubt_after(foretold_[b], compared[static_cast<std::size_t>(i)],
                                               shared.col(i).array());
    }
  }
  Eigen::Index least = 0;
  doubts.minCoeff(&least);
  next_ = levels_[static_cast<std::size_t>(compared[static_cast<std::size_t>(least)])];
}

std::optional<LevelRange> ThresholdSurface::range() const {
  const auto& list = parameters().variables.front().levels;
  return LevelRange{list.front(), list.back()};
}

std::string ThresholdSurface::name_of(const Level& others) const {
  std::string name = "threshold of " + parameters().variables.front().name;
  for (std::size_t k = 0; k < others.size(); ++k) {
    name += fmt::format("{}{} {:.6g}", k == 0 ? " at " : ", ", parameters().variables[k + 1].name,
                        others[k]);
  }
  return name;
}

std::vector<Estimate> ThresholdSurface::estimates() const {
  if (trials_ == 0) {
    return {};
  }
  const std::vector<Level> others = posterior_.told_at();
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
