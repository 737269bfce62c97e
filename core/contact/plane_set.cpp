#include "core/contact/plane_set.h"

#include <Eigen/Geometry>
#include <cmath>

namespace haptrial::contact {
namespace {

using Eigen::Vector3d;

// Three normals with a smaller determinant: their corner is farther off than the rounding of what
// defines it.
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

namespace {

/// A plane's normal and what the proxy lacks of its height.
struct Side {
  Vector3d normal;
  double lack;
};

void solve_one(const Side& a, const Vector3d& wish, PlaneSolution& s) {
  s.push[0] = a.lack - a.normal.dot(wish);
  s.move = wish + s.push[0] * a.normal;
  // The same once more: what rounding left along the normal.
  s.move += (a.lack - a.normal.dot(s.move)) * a.normal;
  s.residual = s.move - wish;
}

void solve_two(const Side& a, const Side& b, const Vector3d& wish, PlaneSolution& s) {
  const Vector3d along = a.normal.cross(b.normal);
  const double square = along.squaredNorm(), c = a.normal.dot(b.normal);
  const double by = 1.0 / square;
  s.solved = square > kParallel;
  s.move = along * (along.dot(wish) * by) +
           ((a.lack - c * b.lack) * a.normal + (b.lack - c * a.lack) * b.normal) * by;
  s.residual = s.move - wish;
  const double r0 = s.residual.dot(a.normal), r1 = s.residual.dot(b.normal);
  s.push = {(r0 - c * r1) * by, (r1 - c * r0) * by, 0.0};
}

void solve_three(const Side& a, const Side& b, const Side& c, const Vector3d& wish,
                 PlaneSolution& s) {
  const Vector3d c0 = b.normal.cross(c.normal), c1 = c.normal.cross(a.normal);
  const Vector3d c2 = a.normal.cross(b.normal);
  const double volume = a.normal.dot(c0);
  const double by = 1.0 / volume;
  s.solved = std::abs(volume) > kFlat;
  s.move = (a.lack * c0 + b.lack * c1 + c.lack * c2) * by;
  s.residual = s.move - wish;
  s.push = {s.residual.dot(c0) * by, s.residual.dot(c1) * by, s.residual.dot(c2) * by};
}

/// Visits every one, every two and every three of `count`, until it is sure.
template <class Visit>
void each_of_up_to_three(int count, const bool& sure, Visit visit) {
  for (int i = 0; i < count && !sure; ++i) {
    visit(std::array{i});
  }
  for (int i = 0; i < count && !sure; ++i) {
    for (int j = i + 1; j < count && !sure; ++j) {
      visit(std::array{i, j});
    }
  }
  for (int i = 0; i < count && !sure; ++i) {
    for (int j = i + 1; j < count && !sure; ++j) {
      for (int k = j + 1; k < count && !sure; ++k) {
        visit(std::array{i, j, k});
      }
    }
  }
}

/// Approximate forces of a few planes, and whether they seem to hold the proxy: none pulls, and no
/// other plane refuses where it ends. Only the products of their normals decide; planes that are
/// nearly parallel stay undecided.
class Pushes {
 public:
  static constexpr int kMost = PlaneSet::kMost;

  /// @param count  of planes
  /// @param normal  of a plane, by its number
  /// @param lack  how much too deep the goal is for it
  template <class Normal, class Lack>
  Pushes(int count, const Normal& normal, const Lack& lack) : count_(count) {
    for (int i = 0; i < count; ++i) {
      lack_[i] = lack(i);
      size_ = std::max(size_, std::abs(lack_[i]));
      for (int j = 0; j < i; ++j) {
        products_[i][j] = products_[j][i] = normal(i).dot(normal(j));
      }
      products_[i][i] = 1.0;
    }
  }

  bool seem_to_hold(std::span<const int> which) const {
    std::array<double, 3> push{};
    const int i = which[0];
    if (which.size() == 1) {
      push = {lack_[i], 0.0, 0.0};
      return holds(which, push, size_);
    }
    const int j = which[1];
    const double c = products_[i][j], square = 1.0 - c * c;
    if (which.size() == 2) {
      push = {lack_[i] - c * lack_[j], lack_[j] - c * lack_[i], 0.0};
      return square > kDoubtful && holds(which, scaled(push, square), size_ / square);
    }
    const int k = which[2];
    const double a = products_[j][k], b = products_[i][k];
    const double x = lack_[i], y = lack_[j], z = lack_[k];
    const double volume = square - a * a - b * b + 2.0 * a * b * c;  // squared
    push = {(1.0 - a * a) * x + (a * b - c) * y + (a * c - b) * z,
            (a * b - c) * x + (1.0 - b * b) * y + (b * c - a) * z,
            (a * c - b) * x + (b * c - a) * y + square * z};
    return volume > kDoubtful && holds(which, scaled(push, volume), size_ / volume);
  }

 private:
  static constexpr double kDoubtful = 1e-4, kRounded = 1e-9;

  static std::array<double, 3> scaled(const std::array<double, 3>& push, double by) {
    return {push[0] / by, push[1] / by, push[2] / by};
  }
  bool holds(std::span<const int> which, const std::array<double, 3>& push, double size) const {
    const double doubt = kRounded * size;
    if (push[0] < -doubt || push[1] < -doubt || push[2] < -doubt) {
      return false;
    }
    for (int i = 0; i < count_; ++i) {
      double lifted = doubt - lack_[i];
      for (std::size_t k = 0; k < which.size(); ++k) {
        lifted += push[k] * products_[i][which[k]];
      }
      if (lifted < 0.0) {
        return false;
      }
    }
    return true;
  }

  int count_;
  std::array<double, kMost> lack_;
  std::array<std::array<double, kMost>, kMost> products_;
  double size_{0.0};
};

}  // namespace

PlaneSolution PlaneSet::solve_on(std::span<const int> which, const Vector3d& proxy,
                                 const Vector3d& wish) const noexcept {
  PlaneSolution s;
  s.count = static_cast<int>(which.size());
  std::copy(which.begin(), which.end(), s.active.begin());
  // A proxy that is too near is lifted by one plane. Two that are nearly parallel would lift it far
  // aside, so they and three leave it where it is.
  const auto side = [&](int i) {
    const ContactPlane& plane = planes_[which[i]];
    const double below = -plane.height(proxy);
    return Side{plane.normal, s.count == 1 ? below : std::min(below, 0.0)};
  };
  switch (s.count) {
    case 1:
      solve_one(side(0), wish, s);
      break;
    case 2:
      solve_two(side(0), side(1), wish, s);
      break;
    default:
      solve_three(side(0), side(1), side(2), wish, s);
  }
  return s;
}

PlaneSolution PlaneSet::solve(const Vector3d& proxy, const Vector3d& wish,
                              double tolerance) const noexcept {
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
  PlaneSolution best;
  best.tried = 0;
  best.move = wish;
  best.residual.setZero();
  if (allowed(wish)) {
    return best;
  }
  best.move.setZero();  // staying where it is is as good as what is no nearer
  best.residual = -wish;
  best.solved = false;
  const double farthest = wish.norm() + 8.0 * tolerance;
  double least = farthest * farthest;
  bool sure = false;  // no plane pulls: then no point is nearer
  int tried = 0;
  const auto visit = [&](std::span<const int> which) {
    const PlaneSolution s = solve_on(which, proxy, wish);
    ++tried;
    const double square = s.residual.squaredNorm();
    if (s.solved && square < least && allowed(s.move)) {
      best = s;
      least = square;
      sure = s.push[0] >= 0.0 && s.push[1] >= 0.0 && s.push[2] >= 0.0;
    }
  };
  // Most often one look is enough; if what seems to hold is not sure, all are looked at.
  if (count_ > 1) {
    const Pushes pushes(
        count_, [&](int i) -> const Vector3d& { return planes_[i].normal; },
        [&](int i) { return most[i] + tolerance - planes_[i].normal.dot(wish); });
    each_of_up_to_three(count_, sure, [&](std::span<const int> which) {
      if (pushes.seem_to_hold(which)) {
        visit(which);
      }
    });
  }
  each_of_up_to_three(count_, sure, visit);
  best.tried = tried;
  return best;
}

}  // namespace haptrial::contact
