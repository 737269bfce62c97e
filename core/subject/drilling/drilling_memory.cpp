#include "core/subject/drilling/drilling_memory.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace haptrial::subject {
namespace {

constexpr float kLittle = 0.4e-3F;     // of bone in a column that is not worth a stroke [m]
constexpr double kPlay = 0.25e-3;      // a burr leaves so much of what it passes over [m]
constexpr float kProgress = 0.15e-3F;  // of a bout that was not in vain [m]
constexpr double kNearby = 0.35;       // metres of depth that a metre of way is worth
constexpr int kAngles = 6;
constexpr double kBeyond = 3e-3;  // strokes under an edge reach so far beyond it [m]

}  // namespace

DrillingMemory::DrillingMemory(const DrillingChart& chart)
    : chart_(chart),
      height_(chart.surface),
      centre_(chart.columns()),
      floor_(chart.surface),
      before_(chart.surface),
      tries_(chart.columns()) {}

void DrillingMemory::begin(const std::vector<float>& surface) noexcept {
  std::copy(surface.begin(), surface.end(), height_.begin());
  std::copy(surface.begin(), surface.end(), before_.begin());
}

void DrillingMemory::begin_burr(const BurrReach& reach, double radius) noexcept {
  std::copy(reach.centre.begin(), reach.centre.end(), centre_.begin());
  std::copy(reach.floor.begin(), reach.floor.end(), floor_.begin());
  std::fill(tries_.begin(), tries_.end(), std::uint8_t{0});
  radius_ = radius;
  double total = 0.0;
  Eigen::Vector3d middle = Eigen::Vector3d::Zero();
  for (int j = 0; j < chart_.size[1]; ++j) {
    for (int i = 0; i < chart_.size[0]; ++i) {
      const std::size_t column = chart_.column(i, j);
      const double left = to_go(column);
      if (left > 0.0) {
        total += left;
        middle += left * Eigen::Vector3d(i * chart_.cell, j * chart_.cell,
                                         static_cast<double>(chart_.surface[column]));
      }
    }
  }
  total_ = std::max(total, 1e-9);
  if (total > 0.0) {
    opening_ = middle / total;
  }
}

float DrillingMemory::to_go(std::size_t column) const noexcept {
  const float floor = floor_[column];
  const float height = height_[column];
  return floor == DrillingChart::kNone || height == DrillingChart::kNone
             ? 0.0F
             : std::max(0.0F, floor - height);
}

DrillingMemory::Cell DrillingMemory::cell_at(const Eigen::Vector2d& place) const noexcept {
  const auto index = [&](double x, int size) {
    return std::clamp(static_cast<int>(std::lround(x / chart_.cell)), 0, size - 1);
  };
  return {index(place.x(), chart_.size[0]), index(place.y(), chart_.size[1])};
}

void DrillingMemory::sweep(const Eigen::Vector3d& place) noexcept {
  const double radius = radius_ - kPlay;
  const int reach = static_cast<int>(std::ceil(radius / chart_.cell));
  const Cell at = cell_at(place.head<2>());
  for (int j = at.j - reach; j <= at.j + reach; ++j) {
    for (int i = at.i - reach; i <= at.i + reach; ++i) {
      const double x = i * chart_.cell - place.x();
      const double y = j * chart_.cell - place.y();
      const double left = radius * radius - x * x - y * y;
      if (inside(i, j) && left > 0.0) {
        float& height = height_[chart_.column(i, j)];
        height = std::max(height, static_cast<float>(place.z() + std::sqrt(left)));
      }
    }
  }
}

double DrillingMemory::limit(const Eigen::Vector2d& place) const noexcept {
  const Cell at = cell_at(place);
  return static_cast<double>(centre_[chart_.column(at.i, at.j)]);
}

double DrillingMemory::touch(const Eigen::Vector2d& place) const noexcept {
  const int reach = static_cast<int>(radius_ / chart_.cell);
  const Cell at = cell_at(place);
  double highest = 1.0;
  for (int j = -reach; j <= reach; ++j) {
    for (int i = -reach; i <= reach; ++i) {
      const double left = radius_ * radius_ - (i * i + j * j) * chart_.cell * chart_.cell;
      if (left >= 0.0 && inside(at.i + i, at.j + j)) {
        const auto height = static_cast<double>(height_[chart_.column(at.i + i, at.j + j)]);
        highest = std::min(highest, height - std::sqrt(left));
      }
    }
  }
  return highest;
}

double DrillingMemory::over(const Eigen::Vector2d& from, const Eigen::Vector2d& to) const noexcept {
  const double length = (to - from).norm();
  const int steps = 1 + static_cast<int>(length / (0.5 * radius_));
  double highest = 1.0;
  for (int s = 0; s <= steps; ++s) {
    highest = std::min(highest, touch(from + (to - from) * s / steps));
  }
  return highest;
}

double DrillingMemory::left() const noexcept {
  double left = 0.0;
  for (std::size_t column = 0; column < height_.size(); ++column) {
    const float here = to_go(column);
    left += here > kLittle ? here : 0.0F;
  }
  return left / total_;
}

/// How many columns from a place on, in a direction, are worth a stroke.
int DrillingMemory::run(const Cell& from, double angle, float highest,
                        const StrokeChoice& choice) const noexcept {
  const int most = static_cast<int>(choice.length / chart_.cell);
  int steps = 0;
  for (int s = 1; s <= most; ++s) {
    const int i = from.i + static_cast<int>(std::lround(s * std::cos(angle)));
    const int j = from.j + static_cast<int>(std::lround(s * std::sin(angle)));
    if (!inside(i, j)) {
      break;
    }
    const std::size_t column = chart_.column(i, j);
    if (to_go(column) < kLittle || height_[column] > highest + static_cast<float>(choice.bite)) {
      break;
    }
    steps = s;
  }
  return steps;
}

bool DrillingMemory::choose(const StrokeChoice& choice, const Eigen::Vector2d& now,
                            RandomStream& random, StrokeSeries& strokes) noexcept {
  double best = 1e9;
  Cell at{-1, -1};
  for (int j = 0; j < chart_.size[1]; ++j) {
    for (int i = 0; i < chart_.size[0]; ++i) {
      const std::size_t column = chart_.column(i, j);
      if (to_go(column) < kLittle) {
        continue;
      }
      const double way = std::hypot(i * chart_.cell - now.x(), j * chart_.cell - now.y());
      // Bone that would fill a stroke comes before rests of strokes.
      const double scant = choice.bite - std::min(choice.bite, static_cast<double>(to_go(column)));
      const double cost = choice.evenness * (static_cast<double>(height_[column]) + 2.0 * scant) +
                          kNearby * (1.0 - 0.7 * choice.evenness) * way;
      if (cost < best) {
        best = cost;
        at = {i, j};
      }
    }
  }
  if (at.i < 0) {
    return false;
  }
  std::copy(height_.begin(), height_.end(), before_.begin());
  const float highest = height_[chart_.column(at.i, at.j)];
  const double first = random.uniform(0.0, std::numbers::pi);
  int longest = -1;
  for (int k = 0; k < kAngles; ++k) {
    const double angle = first + k * std::numbers::pi / kAngles;
    const int ahead = run(at, angle, highest, choice);
    const int back = run(at, angle + std::numbers::pi, highest, choice);
    if (ahead + back > longest) {
      longest = ahead + back;
      const Eigen::Vector2d along(std::cos(angle), std::sin(angle));
      const Eigen::Vector2d middle(at.i * chart_.cell, at.j * chart_.cell);
      strokes.from = middle - back * chart_.cell * along;
      strokes.to = middle + ahead * chart_.cell * along;
    }
  }
  const double length = (strokes.to - strokes.from).norm();
  if (length > choice.length) {
    const Eigen::Vector2d middle = 0.5 * (strokes.from + strokes.to);
    const Eigen::Vector2d half = 0.5 * choice.length / length * (strokes.to - strokes.from);
    strokes.from = middle - half;
    strokes.to = middle + half;
  }
  strokes.under = false;
  if (random.uniform() < choice.undercut) {
    choose_under(at, choice, random, strokes);
  }
  return true;
}

/// Chooses strokes from the deepest place nearby to beyond the edge that is next to it.
void DrillingMemory::choose_under(const Cell& at, const StrokeChoice& choice, RandomStream& random,
                                  StrokeSeries& strokes) noexcept {
  const int reach = static_cast<int>(choice.length / chart_.cell);
  Cell deepest = at;
  float depth = -1.0F;
  for (int j = std::max(0, at.j - reach); j <= std::min(chart_.size[1] - 1, at.j + reach); ++j) {
    for (int i = std::max(0, at.i - reach); i <= std::min(chart_.size[0] - 1, at.i + reach); ++i) {
      const std::size_t column = chart_.column(i, j);
      const float dug = height_[column] - chart_.surface[column];
      if (height_[column] != DrillingChart::kNone && dug > depth) {
        depth = dug;
        deepest = {i, j};
      }
    }
  }
  if (static_cast<double>(depth) < 2.0 * radius_) {
    return;  // there is no edge yet
  }
  const float bottom = height_[chart_.column(deepest.i, deepest.j)];
  const double angle = random.uniform(0.0, 2.0 * std::numbers::pi);
  const Eigen::Vector2d along(std::cos(angle), std::sin(angle));
  const Eigen::Vector2d start(deepest.i * chart_.cell, deepest.j * chart_.cell);
  for (int s = 1; s <= 4 * reach; ++s) {
    const Eigen::Vector2d place = start + s * chart_.cell * along;
    const Cell there = cell_at(place);
    const float standing = height_[chart_.column(there.i, there.j)];
    if (standing < bottom - static_cast<float>(2.0 * radius_)) {
      strokes = {start, place + kBeyond * along, true};
      return;
    }
  }
}

void DrillingMemory::end_strokes(const StrokeSeries& strokes) noexcept {
  if (strokes.under) {
    return;
  }
  const Eigen::Vector2d middle = 0.5 * (strokes.from + strokes.to);
  const double reach = 0.5 * (strokes.to - strokes.from).norm() + 0.5 * radius_;
  const Cell low = cell_at(middle.array() - reach);
  const Cell high = cell_at(middle.array() + reach);
  const Eigen::Vector2d way = strokes.to - strokes.from;
  const double square = std::max(way.squaredNorm(), 1e-12);
  for (int j = low.j; j <= high.j; ++j) {
    for (int i = low.i; i <= high.i; ++i) {
      const Eigen::Vector2d place(i * chart_.cell, j * chart_.cell);
      const double along = std::clamp((place - strokes.from).dot(way) / square, 0.0, 1.0);
      const std::size_t column = chart_.column(i, j);
      const bool passed = (strokes.from + along * way - place).norm() < 0.5 * radius_;
      if (passed && height_[column] < before_[column] + kProgress && ++tries_[column] >= 3) {
        height_[column] = std::max(height_[column], floor_[column]);
      }
    }
  }
}

}  // namespace haptrial::subject
