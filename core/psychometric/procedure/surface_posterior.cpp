#include "core/psychometric/procedure/surface_posterior.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "core/base/random.h"
#include "core/psychometric/function/sigmoid.h"

namespace haptrial::psychometric {
namespace {

constexpr const char* kProcedure = "ThresholdSurface";
constexpr std::array kSlopes{1.5, 4.0, 10.0};
constexpr std::array kBends{0.25, 1.0, 1.0};
constexpr std::array kLengths{1.2, 1.2, 0.7};  // of each bend
constexpr double kSteep = 20.0;                // of a link that is a step nearly
constexpr std::size_t kPlaces = 33;            // along a line on which a threshold is sought
constexpr double kDraws = 2000.0;
constexpr Eigen::Index kDrawnAtOnce = 100;
constexpr double kUnlikely = 0.02;  // weight of a belief that is left out

std::vector<double> multiples(std::size_t count) {
  std::vector<double> places(count);
  for (std::size_t i = 0; i < count; ++i) {
    places[i] = -1.0 + 2.0 * static_cast<double>(i) / static_cast<double>(count - 1);
  }
  return places;
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

void check(const SurfaceParameters& p) {
  checks::require(!p.variables.empty() && p.variables.size() <= 4, kProcedure,
                  "variables must be 1 to 4");
  for (const SurfaceVariable& each : p.variables) {
    checks::require(
        each.levels.size() >= 2 &&
            std::ranges::adjacent_find(each.levels, std::greater_equal<>()) == each.levels.end(),
        kProcedure, "levels of " + each.name + " must be 2 or more that rise");
  }
  checks::require(p.guess >= 0.0 && p.lapse >= 0.0 && p.guess + p.lapse < 1.0, kProcedure,
                  "guess and lapse must be at least 0 and their sum below 1");
  checks::require(p.target > p.guess && p.target < 1.0 - p.lapse, kProcedure,
                  "target must be above guess and below 1 - lapse");
  checks::require(p.trials >= 1, kProcedure, "trials must be 1 or more");
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

}  // namespace

std::vector<Level> combinations(const std::vector<std::vector<double>>& lists) {
  std::vector<Level> all{{}};
  for (const auto& list : lists) {
    std::vector<Level> longer;
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

SurfacePosterior::SurfacePosterior(const SurfaceParameters& parameters)
    : parameters_(meant(parameters)),
      basis_(parameters.variables.size()),
      f_at_target_(f_at(parameters_)) {
  begin_beliefs();
}

void SurfacePosterior::begin_beliefs() {
  const std::size_t d = basis_.dimensions();
  const auto grid = combinations(std::vector(d, multiples(d <= 2 ? 5 : d == 3 ? 4 : 3)));
  for (std::size_t k = 0; k < d; ++k) {
    for (std::size_t i = 0; (k == 0 || parameters_.variables[k].rises) && i < grid.size(); ++i) {
      rises_.push_back(kSteep * basis_.slope(grid[i], k));
    }
  }
  for (const double slope : kSlopes) {
    for (std::size_t b = 0; b < kBends.size(); ++b) {
      const Smoothness smoothness{slope, kBends[b], kLengths[b]};
      Belief belief{SmoothBelief(basis_.deviations(smoothness))};
      for (int round = 0; round < 2; ++round) {
        for (std::size_t i = 0; i < rises_.size(); ++i) {
          belief.of_terms.visit(i, rises_[i], {});
        }
      }
      beliefs_.push_back(std::move(belief));
    }
  }
  weigh();
}

/// Numbers from -1 to 1, by the places of the levels in their lists.
std::vector<double> SurfacePosterior::place_of(const Level& level) const {
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

ProbitLink SurfacePosterior::link_of(bool answer) const noexcept {
  const double share = 1.0 - parameters_.guess - parameters_.lapse;
  return answer ? ProbitLink{parameters_.guess, share, 1.0}
                : ProbitLink{parameters_.lapse, share, -1.0};
}

bool SurfacePosterior::is_unlikely(const Belief& belief) noexcept {
  return belief.weight < kUnlikely;
}

std::vector<SmoothBelief::Visit> SurfacePosterior::report(bool answer, const Level& level) {
  shown_.push_back(row_of(level));
  answers_.push_back(answer);
  const std::size_t fact = rises_.size() + shown_.size() - 1;
  std::vector<SmoothBelief::Visit> visits;
  for (Belief& each : beliefs_) {
    visits.push_back(each.of_terms.visit(fact, shown_.back(), link_of(answer)));
    each.evidence += std::log(visits.back().probability);
  }
  weigh();
  return visits;
}

void SurfacePosterior::weigh() {
  const double best = std::ranges::max_element(beliefs_, {}, &Belief::evidence)->evidence;
  double sum = 0.0;
  for (Belief& each : beliefs_) {
    each.weight = std::exp(each.evidence - best);
    sum += each.weight;
  }
  for (Belief& each : beliefs_) {
    each.weight /= sum;
  }
}

/// The likely beliefs with every fact visited again, so that their order no longer matters.
std::vector<SurfacePosterior::Belief> SurfacePosterior::refined() const {
  constexpr int kRounds = 5;
  std::vector<Belief> likely;
  std::ranges::copy_if(beliefs_, std::back_inserter(likely),
                       [](const Belief& each) { return !is_unlikely(each); });
  for (Belief& each : likely) {
    for (int round = 0; round < kRounds; ++round) {
      for (std::size_t i = 0; i < rises_.size(); ++i) {
        each.of_terms.visit(i, rises_[i], {});
      }
      for (std::size_t i = 0; i < shown_.size(); ++i) {
        each.of_terms.visit(rises_.size() + i, shown_[i], link_of(answers_[i]));
      }
    }
  }
  return likely;
}

std::vector<Level> SurfacePosterior::told_at() const {
  constexpr std::array<std::size_t, 4> kMost{1, 5, 3, 3};
  std::vector<std::vector<double>> lists;
  for (std::size_t k = 1; k < parameters_.variables.size(); ++k) {
    lists.push_back(thinned(parameters_.variables[k].levels, kMost[basis_.dimensions() - 1]));
  }
  return combinations(lists);
}

/// Terms of f at kPlaces places along the first variable, for each of `others`.
Eigen::MatrixXd SurfacePosterior::rows_along(const std::vector<Level>& others) const {
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
  return rows;
}

/// Draws of the first variable's threshold at each of `others`, a row each; infinite where f
/// crosses nowhere in the range.
Eigen::MatrixXd SurfacePosterior::drawn_thresholds(const std::vector<Level>& others) const {
  const Eigen::MatrixXd rows = rows_along(others);
  Eigen::MatrixXd all(static_cast<Eigen::Index>(others.size()), 0);
  RandomStream random(0, "threshold surface");
  for (const Belief& each : refined()) {
    Eigen::MatrixXd covariance = each.of_terms.covariance();
    covariance.diagonal().array() += 1e-10;
    const Eigen::MatrixXd root = Eigen::LLT<Eigen::MatrixXd>(covariance).matrixL();
    const Eigen::MatrixXd spread = rows * root;
    const Eigen::VectorXd mean = rows * each.of_terms.mean();
    auto left = static_cast<Eigen::Index>(std::lround(kDraws * each.weight));
    for (; left > 0; left -= kDrawnAtOnce) {
      const Eigen::MatrixXd z =
          Eigen::MatrixXd::NullaryExpr(basis_.size(), std::min(left, kDrawnAtOnce),
                                       [&](Eigen::Index, Eigen::Index) { return random.normal(); });
      const Eigen::MatrixXd f = (spread * z).colwise() + mean;
      const Eigen::Index first = all.cols();
      all.conservativeResize(Eigen::NoChange, first + f.cols());
      for (Eigen::Index i = 0; i < f.cols(); ++i) {
        all.col(first + i) = thresholds_of(f.col(i));
      }
    }
  }
  return all;
}

/// @param f  kPlaces values along the first variable after each other
Eigen::VectorXd SurfacePosterior::thresholds_of(const Eigen::VectorXd& f) const {
  constexpr auto kStretch = static_cast<Eigen::Index>(kPlaces);
  const auto& list = parameters_.variables.front().levels;
  Eigen::VectorXd found(f.size() / kStretch);
  for (Eigen::Index line = 0; line < found.size(); ++line) {
    const auto along = f.segment(line * kStretch, kStretch).array() - f_at_target_;
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

std::vector<SurfaceThreshold> SurfacePosterior::thresholds(const std::vector<Level>& others) const {
  const std::vector<double>& levels = parameters_.variables.front().levels;
  const Eigen::MatrixXd drawn = drawn_thresholds(others);
  std::vector<SurfaceThreshold> all;
  for (Eigen::Index i = 0; i < drawn.rows(); ++i) {
    std::vector<double> one(static_cast<std::size_t>(drawn.cols()));
    Eigen::RowVectorXd::Map(one.data(), drawn.cols()) = drawn.row(i);
    std::ranges::sort(one);
    const auto share = [&](double p) {
      return one[static_cast<std::size_t>(p * static_cast<double>(one.size() - 1))];
    };
    all.push_back({share(0.5), std::min(share(0.025), levels.back()),
                   std::max(share(0.975), levels.front())});
  }
  return all;
}

}  // namespace haptrial::psychometric
