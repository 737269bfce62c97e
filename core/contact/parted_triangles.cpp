#include "core/contact/parted_triangles.h"

#include <algorithm>
#include <bit>
#include <cstring>

namespace haptrial::contact {
namespace {

using Eigen::Vector3d;
using geometry::larger;
using geometry::smaller;

/// Bound of the rounding error, in single precision, of a sum of a dozen numbers of size 1.
constexpr double kPartedRounded = 4e-6;
/// An axis is turned by the rounding to single precision: a corner comes before its plane by less
/// than this part of how far the corner is.
constexpr double kTurned = 1.2e-7;
/// The same for a level that is computed in single precision, of corners that are rounded to it.
constexpr float kLevelled = 2e-6f;
/// A plane that keeps nothing apart.
constexpr float kNowhere = 1e30f;

Four load_four(const std::vector<float>& from, int i) {
  Four x;
  std::memcpy(&x, from.data() + i, sizeof x);
  return x;
}

void store_four(std::vector<float>& to, int i, Four x) { std::memcpy(to.data() + i, &x, sizeof x); }

FourVectors four_times(const Vector3d& v) {
  return {all_four(static_cast<float>(v.x())), all_four(static_cast<float>(v.y())),
          all_four(static_cast<float>(v.z()))};
}

/// The part of a move until which it stays above a plane for sure.
double not_before(float height, float rise) {
  constexpr double kLess = 1.0 - 1e-6;  // than what is rounded
  return height > 0.0f ? kLess * static_cast<double>(height / -rise) : 0.0;
}

}  // namespace

PartedTriangles::PartedTriangles(std::size_t most)
    : slots_(most + 4),
      planes_(most + 4),
      flat_(most + 4),
      x_(most + 4),
      y_(most + 4),
      z_(most + 4),
      level_(most + 4) {}

void PartedTriangles::clear(const Vector3d& middle, double reach) noexcept {
  middle_ = middle;
  scale_ = 1.0 / std::max(reach, 1e-300);
  count_ = 0;
}

void PartedTriangles::add(std::int32_t slot, const geometry::Corners& corners) noexcept {
  const int i = count_++;
  slots_[i] = slot;
  planes_[i].known = false;
  Flat& flat = flat_[i];
  for (int k = 0; k < 3; ++k) {
    const Vector3d at = scale_ * (corners[k] - middle_);
    flat.x[k] = static_cast<float>(at.x());
    flat.y[k] = static_cast<float>(at.y());
    flat.z[k] = static_cast<float>(at.z());
  }
}

FourTriangles PartedTriangles::four(const std::array<int, 4>& which) const noexcept {
  const Flat &p = flat_[which[0]], &q = flat_[which[1]], &r = flat_[which[2]], &s = flat_[which[3]];
  const auto corner = [&](int k) {
    return FourVectors{Four{p.x[k], q.x[k], r.x[k], s.x[k]}, Four{p.y[k], q.y[k], r.y[k], s.y[k]},
                       Four{p.z[k], q.z[k], r.z[k], s.z[k]}};
  };
  return {corner(0), corner(1), corner(2)};
}

void PartedTriangles::part_all(const Vector3d& from) noexcept {
  const FourVectors p = four_times(scale_ * (from - middle_));
  for (int i = 0; i < count_; i += 4) {
    const FourTriangles t = four({i, i + 1, i + 2, i + 3});
    const FourVectors axis = of_length_one(p - t.middle());
    const Four level = t.level(axis) + all_four(kLevelled) * t.far();
    const FourInts sound = level < kNowhere;  // not where nothing is known
    store_four(x_, i, axis.x);
    store_four(y_, i, axis.y);
    store_four(z_, i, axis.z);
    store_four(level_, i, sound ? level : all_four(kNowhere));
  }
  for (int beyond = count_; beyond % 4 != 0; ++beyond) {
    x_[beyond] = y_[beyond] = z_[beyond] = 0.0f;
    level_[beyond] = -kNowhere;  // nothing, far behind its plane
  }
}

void PartedTriangles::part(int i, const geometry::Corners& corners, const Vector3d& axis) noexcept {
  Plane& plane = planes_[i];
  const Vector3d a = corners[0] - middle_, b = corners[1] - middle_, c = corners[2] - middle_;
  plane.axis = axis;
  plane.level = std::max({axis.dot(a), axis.dot(b), axis.dot(c)});
  plane.known = true;
  x_[i] = static_cast<float>(axis.x());
  y_[i] = static_cast<float>(axis.y());
  z_[i] = static_cast<float>(axis.z());
  const double far = std::max({a.lpNorm<1>(), b.lpNorm<1>(), c.lpNorm<1>()});
  const double level = scale_ * (plane.level + kTurned * far);
  level_[i] = static_cast<float>(std::min<double>(level, kNowhere));
}

PartedTriangles::Move PartedTriangles::in_list(const Vector3d& from, const Vector3d& move,
                                               double off) const noexcept {
  const Vector3d in_list = from - middle_, at = scale_ * in_list, way = scale_ * move;
  const double size = 1.0 + at.lpNorm<1>() + way.lpNorm<1>() + scale_ * off;
  const float apart = static_cast<float>(scale_ * off + kPartedRounded * size);
  return {in_list, move, off, four_times(at), four_times(way), all_four(apart)};
}

int PartedTriangles::within(const Move& move, std::span<Candidate> found) const noexcept {
  int count = 0;
  for (int first = 0; first < count_; first += 4) {
    const FourVectors axis{load_four(x_, first), load_four(y_, first), load_four(z_, first)};
    const Four height = axis.dot(move.p) - load_four(level_, first) - move.apart;
    const Four rise = axis.dot(move.v);
    const FourInts apart = smaller(height, height + rise) > 0.0f;
    for (unsigned left = ~geometry::bits(apart) & 15u; left != 0; left &= left - 1) {
      const int lane = std::countr_zero(left), i = first + lane;
      const Plane& plane = planes_[i];
      if (!plane.known) {
        found[count++] = {i, not_before(height[lane], rise[lane]), false};
        continue;
      }
      const double above = plane.axis.dot(move.from) - plane.level - move.off;
      const double gain = plane.axis.dot(move.way);
      if (std::min(above, above + gain) <= 0.0) {
        found[count++] = {i, above > 0.0 ? above / -gain : 0.0, scale_ * above < kPartedRounded};
      }
    }
  }
  return count;
}

FourVectors PartedTriangles::Move::beside(const FourVectors& place) const noexcept {
  const Four part = v.dot(place - p) / larger(v.dot(v), all_four(1e-30f));
  return p + v * smaller(larger(part, all_four(0.0f)), all_four(1.0f));
}

/// A plane for each of four triangles.
struct PartedTriangles::FourPlanes {
  FourVectors axis;
  Four level, height, gain, least;  // least: of the heights of a move

  FourPlanes(const FourTriangles& t, const FourVectors& way, const Move& move) noexcept
      : axis(of_length_one(way)),
        level(t.level(axis) + all_four(kLevelled) * t.far()),
        height(axis.dot(move.p) - level - move.apart),
        gain(axis.dot(move.v)),
        least(smaller(height, height + gain)) {}

  void take_better(const FourPlanes& other) noexcept {
    const FourInts better = other.least > least;
    axis = either(better, other.axis, axis);
    level = better ? other.level : level;
    height = better ? other.height : height;
    gain = better ? other.gain : gain;
    least = better ? other.least : least;
  }
};

/// The best of planes across the way from the nearest point, along the face and, if one of the
/// `wanted` is left, along an edge and the move.
PartedTriangles::FourPlanes PartedTriangles::best_planes(const FourTriangles& t, const Move& move,
                                                         unsigned wanted) noexcept {
  const TriangleVectors vectors(t, move.beside(t.middle()));
  FourPlanes best(t, vectors.nearest, move);
  best.take_better({t, vectors.face, move});
  if ((~geometry::bits(best.least > 0.0f) & wanted) != 0) {
    for (const FourVectors& edge : {t.b - t.a, t.c - t.b, t.a - t.c}) {
      best.take_better({t, outwards(move.v.cross(edge), move.p - t.middle()), move});
    }
  }
  return best;
}

int PartedTriangles::part_anew(const Move& move, std::span<Candidate> found) noexcept {
  const int count = static_cast<int>(found.size());
  std::array<int, kTogether> which{};
  unsigned wanted = 0;
  for (int k = 0; k < count; ++k) {
    which[k] = found[k].i;
    wanted |= found[k].touched ? 0u : 1u << k;
  }
  if (wanted == 0) {
    return count;  // exact planes of what is touched are as good as can be
  }
  const FourPlanes best = best_planes(four(which), move, wanted);
  int kept = 0;
  for (int k = 0; k < count; ++k) {
    Candidate c = found[k];
    if (best.least[k] > 0.0f && !c.touched) {
      x_[c.i] = best.axis.x[k];
      y_[c.i] = best.axis.y[k];
      z_[c.i] = best.axis.z[k];
      level_[c.i] = best.level[k];
      planes_[c.i].known = false;
      continue;
    }
    c.t = std::max(c.t, not_before(best.height[k], best.gain[k]));
    found[kept++] = c;
  }
  return kept;
}

}  // namespace haptrial::contact
