#include "analysis/psychometric/fit/contour.h"

#include <algorithm>
#include <array>
#include <limits>
#include <stdexcept>

#include "analysis/statistics/base/descriptive.h"

namespace haptrial::analysis {
namespace {

constexpr std::size_t kSide = 41;  // values of each variable
constexpr double kContourTail = 0.025;

std::vector<double> even(const std::vector<double>& values, std::size_t count) {
  const auto [low, high] = std::minmax_element(values.begin(), values.end());
  std::vector<double> steps;
  for (std::size_t i = 0; i < count; ++i) {
    steps.push_back(*low +
                    (*high - *low) * static_cast<double>(i) / static_cast<double>(count - 1));
  }
  return steps;
}

/// Place of the level on a straight line from a to b, from 0 to 1.
double where(double a, double b, double level) { return (level - a) / (b - a); }

}  // namespace

ThresholdMap::ThresholdMap(const psychometric::QuestDefinition& d, const SurfaceFit& fit,
                           double share)
    : share_(share) {
  if (d.stimulus.size() != 2 || d.outcomes != 2 || d.stimulus[0].values.size() < 2 ||
      d.stimulus[1].values.size() < 2) {
    throw std::invalid_argument(
        "a contour is of two variables with several values, and of two "
        "answers");
  }
  first_ = even(d.stimulus[0].values, kSide);
  second_ = even(d.stimulus[1].values, kSide);
  for (Map* map : {&low_, &middle_, &high_}) {
    map->reserve(kSide * kSide);
  }
  std::vector<double> values(fit.draws.size());
  std::array<double, 2> p{};
  for (const double first : first_) {
    for (const double second : second_) {
      const std::array<double, 2> stimulus{first, second};
      for (std::size_t draw = 0; draw < values.size(); ++draw) {
        d.model(stimulus.data(), fit.draws[draw].data(), p.data());
        values[draw] = p[1];
      }
      low_.push_back(*quantile(values, kContourTail));
      middle_.push_back(*quantile(values, 0.5));
      high_.push_back(*quantile(values, 1.0 - kContourTail));
    }
  }
}

Contour ThresholdMap::contour() const { return {share_, line(middle_), line(low_), line(high_)}; }

/// Marching squares: each square of the grid has a piece of the line for each pair of its sides
/// that the line crosses.
std::vector<Segment> ThresholdMap::line(const Map& map) const {
  const auto at = [&](std::size_t i, std::size_t j) { return map[i * second_.size() + j]; };
  std::vector<Segment> segments;
  for (std::size_t i = 0; i + 1 < first_.size(); ++i) {
    for (std::size_t j = 0; j + 1 < second_.size(); ++j) {
      const std::array<std::array<std::size_t, 2>, 5> corners{
          {{i, j}, {i + 1, j}, {i + 1, j + 1}, {i, j + 1}, {i, j}}};
      std::vector<std::pair<double, double>> crossed;
      for (std::size_t side = 0; side < 4; ++side) {
        const auto [a, b] = corners[side];
        const auto [c, e] = corners[side + 1];
        const double from = at(a, b), to = at(c, e);
        if ((from < share_) != (to < share_)) {
          const double share = where(from, to, share_);
          crossed.emplace_back(first_[a] + share * (first_[c] - first_[a]),
                               second_[b] + share * (second_[e] - second_[b]));
        }
      }
      for (std::size_t k = 0; k + 1 < crossed.size(); k += 2) {
        segments.emplace_back(crossed[k], crossed[k + 1]);
      }
    }
  }
  return segments;
}

std::vector<double> ThresholdMap::crossings(double first, const Map& map) const {
  const double place = (first - first_.front()) / (first_.back() - first_.front()) *
                       static_cast<double>(first_.size() - 1);
  const auto left = std::min(static_cast<std::size_t>(place), first_.size() - 2);
  const double share = place - static_cast<double>(left);
  const auto value = [&](std::size_t j) {
    const double here = map[left * second_.size() + j];
    return here + share * (map[(left + 1) * second_.size() + j] - here);
  };
  std::vector<double> found;
  for (std::size_t j = 0; j + 1 < second_.size(); ++j) {
    const double from = value(j), to = value(j + 1);
    if ((from < share_) != (to < share_)) {
      found.push_back(second_[j] + where(from, to, share_) * (second_[j + 1] - second_[j]));
    }
  }
  return found;
}

std::vector<ContourPoint> ThresholdMap::points(std::size_t count) const {
  constexpr double kNoLevel = std::numeric_limits<double>::quiet_NaN();
  std::vector<ContourPoint> all;
  for (const double first : even(first_, count)) {
    ContourPoint point{first, crossings(first, middle_), kNoLevel, kNoLevel};
    const auto sure = crossings(first, low_), hardly = crossings(first, high_);
    if (point.second.size() == 1) {
      const double a = sure.size() == 1 ? sure.front() : kNoLevel;
      const double b = hardly.size() == 1 ? hardly.front() : kNoLevel;
      const bool rising = a > point.second.front() || b < point.second.front();
      point.low = rising ? b : a;
      point.high = rising ? a : b;
    }
    all.push_back(std::move(point));
  }
  return all;
}

}  // namespace haptrial::analysis
