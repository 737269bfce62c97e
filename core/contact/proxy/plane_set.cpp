#include "core/contact/proxy/plane_set.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

namespace haptrial::contact {
namespace {

using Eigen::Vector3d;

// Two normals closer than 2^-22 rad, three with a smaller determinant: their line or corner is
// farther off than the rounding of what defines it.
constexpr double kParallel = 0x1p-44;
constexpr double kFlat = 0x1p-30;

}  // namespace

bool PlaneSet::has(const ContactPlane& plane) const noexcept {
  return std::any_of(planes_.begin(), planes_.begin() + count_, [&](const ContactPlane& known) {
    return known.slot == plane.slot && known.normal == plane.normal;
  });
}

bool PlaneSet::add(const ContactPlane& plane) noexcept {
  if (count_ == kMost || has(plane)) {
    return false;
  }
  planes_[count_++] = plane;
  return true;
}

PlaneSolution PlaneSet::solve_on(std::span<const int> which, const Vector3d& proxy,
                                 const Vector3d& wish) const noexcept {
  PlaneSolution s;
  s.count = static_cast<int>(which.size());
  for (int i = 0; i < s.count; ++i) {
    s.active[i] = which[i];
  }
  // A proxy that is too near is lifted by one plane. Two that are nearly parallel would lift it far
  // aside, so they and three leave it where it is.
  const auto deficit = [&](int i) {
    const double below = -planes_[which[i]].height(proxy);
    return s.count == 1 ? below : std::min(below, 0.0);
  };
  const Vector3d& n0 = planes_[which[0]].normal;
  const double b0 = deficit(0);
  if (s.count == 1) {
    s.push[0] = b0 - n0.dot(wish);
    s.move = wish + s.push[0] * n0;
    // The same once more: what rounding left along the normal.
    s.move += (b0 - n0.dot(s.move)) * n0;
    s.residual = s.move - wish;
    return s;
  }
  const Vector3d& n1 = planes_[which[1]].normal;
  const double b1 = deficit(1);
  if (s.count == 2) {
    const Vector3d along = n0.cross(n1);
    const double square = along.squaredNorm();
    s.solved = square > kParallel;
    const double c = n0.dot(n1);
    s.move =
        along * (along.dot(wish) / square) + ((b0 - c * b1) * n0 + (b1 - c * b0) * n1) / square;
    s.residual = s.move - wish;
    const double r0 = s.residual.dot(n0), r1 = s.residual.dot(n1);
    s.push = {(r0 - c * r1) / square, (r1 - c * r0) / square, 0.0};
    return s;
  }
  const Vector3d& n2 = planes_[which[2]].normal;
  const double b2 = deficit(2);
  const Vector3d c0 = n1.cross(n2), c1 = n2.cross(n0), c2 = n0.cross(n1);
  const double volume = n0.dot(c0);
  s.solved = std::abs(volume) > kFlat;
  s.move = (b0 * c0 + b1 * c1 + b2 * c2) / volume;
  s.residual = s.move - wish;
  s.push = {s.residual.dot(c0) / volume, s.residual.dot(c1) / volume, s.residual.dot(c2) / volume};
  return s;
}

PlaneSolution PlaneSet::solve(const Vector3d& proxy, const Vector3d& wish,
                              double tolerance) const noexcept {
  PlaneSolution best;
  best.tried = 0;
  best.move = wish;
  best.residual.setZero();
  double least = 0.0;
  std::array<double, kMost> most;  // what a move may lose of each plane's height
  for (int i = 0; i < count_; ++i) {
    most[i] = -std::max(planes_[i].height(proxy), 0.0) - tolerance;
  }
  const auto allowed = [&](const Vector3d& move) {
    for (int i = 0; i < count_; ++i) {
      if (planes_[i].normal.dot(move) < most[i]) {
        return false;
      }
    }
    return true;
  };
  if (allowed(wish)) {
    return best;
  }
  best.solved = false;
  const double farthest = wish.norm() + 8.0 * tolerance;  // staying where it is is as good
  least = farthest * farthest;
  bool sure = false;  // no plane pulls: then no point is nearer
  int tried = 0;
  const auto consider = [&](std::span<const int> which) {
    const PlaneSolution s = solve_on(which, proxy, wish);
    ++tried;
    const double square = s.residual.squaredNorm();
    if (s.solved && square < least && allowed(s.move)) {
      best = s;
      least = square;
      sure = s.push[0] >= 0.0 && s.push[1] >= 0.0 && s.push[2] >= 0.0;
    }
  };
  for (int i = 0; i < count_ && !sure; ++i) {
    consider(std::array{i});
  }
  for (int i = 0; i < count_ && !sure; ++i) {
    for (int j = i + 1; j < count_ && !sure; ++j) {
      consider(std::array{i, j});
    }
  }
  for (int i = 0; i < count_ && !sure; ++i) {
    for (int j = i + 1; j < count_ && !sure; ++j) {
      for (int k = j + 1; k < count_ && !sure; ++k) {
        consider(std::array{i, j, k});
      }
    }
  }
  if (!best.solved) {
    best.move.setZero();
    best.residual = -wish;
    best.count = 0;
  }
  best.tried = tried;
  return best;
}

}  // namespace haptrial::contact
