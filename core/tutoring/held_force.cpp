#include "core/tutoring/held_force.h"

#include "core/base/longer.h"

namespace haptrial::tutoring {
namespace {

using Eigen::Vector3d;

constexpr std::size_t kFarthest = 100;  // back [ticks]
constexpr std::size_t kShape = 2;       // ticks before the present one that are compared
constexpr std::size_t kAhead = 16;      // [ticks]
constexpr double kLevel = 0.3;          // weight of the level of the force beside its shape
constexpr double kLess = 0.5;           // each analogue counts less than the one before
constexpr double kInside = 0.98;        // of the bound

/// The point of a ball around `middle` that is nearest to `p`.
Vector3d within(const Vector3d& middle, double radius, const Vector3d& p) noexcept {
  const Vector3d away = p - middle;
  return longer(away, radius) ? Vector3d(middle + radius / away.norm() * away) : p;
}

}  // namespace

void HeldForce::add(const Vector3d& force) noexcept {
  forces_[count_ % kHistory] = force;
  ++count_;
}

/// How unlike the present the forces of a moment are, and those just before, beside its level.
double HeldForce::difference(std::size_t ago) const noexcept {
  const Vector3d level = at(ago) - at(0);
  double sum = kLevel * level.squaredNorm();
  for (std::size_t i = 1; i <= kShape; ++i) {
    sum += (at(ago + i) - at(i) - level).squaredNorm() / static_cast<double>(1 + i);
  }
  return sum;
}

/// Keeps the nearest, in order.
void HeldForce::Analogues::offer(const Analogue& one) noexcept {
  if (count == kAnalogues && !(one.difference < all[count - 1].difference)) {
    return;
  }
  std::size_t place = count < kAnalogues ? count++ : count - 1;
  for (; place > 0 && one.difference < all[place - 1].difference; --place) {
    all[place] = all[place - 1];
  }
  all[place] = one;
}

HeldForce::Analogues HeldForce::nearest() const noexcept {
  Analogues nearest;
  for (std::size_t ago = 2; ago <= kFarthest && ago + kShape < count_; ++ago) {
    nearest.offer({difference(ago), ago});
  }
  return nearest;
}

double HeldForce::lasts(const Vector3d& held, const Analogues& analogues,
                        double most) const noexcept {
  double sum = 0.0;
  for (std::size_t i = 0; i < analogues.count; ++i) {
    const std::size_t ago = analogues.all[i].ago;
    std::size_t t = 1;
    while (t <= kAhead && t <= ago && !longer(coming(ago, t) - held, most)) {
      ++t;
    }
    sum += static_cast<double>(t) / (1.0 + kLess * static_cast<double>(i));
  }
  return sum;
}

Vector3d HeldForce::choose(double most) const noexcept {
  const Vector3d now = at(0);
  if (!now.allFinite()) {
    return now;
  }
  const Analogues analogues = nearest();
  Vector3d best = now;
  double longest = lasts(now, analogues, most);
  for (std::size_t i = 0; i < analogues.count; ++i) {
    const std::size_t ago = analogues.all[i].ago;
    Vector3d low = now;
    Vector3d high = now;
    for (std::size_t t = 1; t <= kAhead && t <= ago; ++t) {
      low = low.cwiseMin(coming(ago, t));
      high = high.cwiseMax(coming(ago, t));
      if ((t & (t + 1)) != 0) {
        continue;
      }
      const Vector3d middle = within(now, kInside * most, 0.5 * (low + high));
      const double time = lasts(middle, analogues, most);
      if (middle.allFinite() && time > longest) {
        best = middle;
        longest = time;
      }
    }
  }
  return best;
}

}  // namespace haptrial::tutoring
