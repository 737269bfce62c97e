#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "core/contact/proxy/sweep.h"

namespace haptrial::contact {
namespace {

using Eigen::Vector3d;

/// Clips a move against the half-spaces of a convex body and remembers the one that it enters last.
class Clip {
 public:
  Clip(const Sweep& sweep, double end) : sweep_(sweep), leave_(end) {}

  /// The body lies where out · (x - point) <= level. @returns false if the move misses the body.
  bool cut(const Vector3d& out, const Vector3d& point, double level) {
    const double above = out.dot(sweep_.from - point) - level;
    const double rate = out.dot(sweep_.move);
    if (above > 0.0) {
      if (rate >= 0.0) {
        return false;
      }
      const double t = -above / rate;
      if (t > enter_) {
        enter_ = t;
        entered_ = true;
        out_ = out;
        point_ = point;
        level_ = level;
      }
    } else if (-above < leave_ * rate) {
      leave_ = -above / rate;
    }
    return enter_ <= leave_;
  }

  bool entered() const { return entered_; }
  /// The plane through which the body is entered, `gap` farther out, and where the move meets it.
  void stop(double gap, SweepHit& hit) const {
    const double length = out_.norm();
    hit.plane.normal = out_ / length;
    hit.plane.point = point_;
    hit.plane.level = level_ / length + gap;
    const double height = hit.plane.height(sweep_.from);
    const double rate = hit.plane.normal.dot(sweep_.move);
    hit.t = rate < 0.0 ? std::clamp(-height / rate, 0.0, enter_) : 0.0;
  }

 private:
  const Sweep& sweep_;
  double enter_{-1.0}, leave_;
  bool entered_{false};
  Vector3d out_{Vector3d::Zero()}, point_{Vector3d::Zero()};
  double level_{0.0};
};

/// The half-spaces across the sides of a triangle and, against the spikes that two of those make at
/// a sharp corner, the two across the ends of its longest side.
bool cut_sides(const geometry::Corners& c, const Vector3d& normal, double wider, Clip& clip) {
  int longest = 0;
  double longest_square = -1.0;
  for (int k = 0; k < 3; ++k) {
    const Vector3d edge = c[(k + 1) % 3] - c[k], across = c[(k + 2) % 3] - c[k];
    const double square = edge.squaredNorm();
    if (square > longest_square) {
      longest_square = square;
      longest = k;
    }
    Vector3d out = edge.cross(normal);
    if (out.dot(across) > 0.0) {
      out = -out;
    }
    const double support = std::max({0.0, out.dot(edge), out.dot(across)});
    if (!clip.cut(out, c[k], support + wider * out.norm())) {
      return false;
    }
  }
  const Vector3d &start = c[longest], &tip = c[(longest + 1) % 3], &third = c[(longest + 2) % 3];
  const Vector3d along = tip - start;
  const double beyond = wider * std::sqrt(longest_square);
  return clip.cut(along, tip, std::max(0.0, along.dot(third - tip)) + beyond) &&
         clip.cut(-along, start, std::max(0.0, -along.dot(third - start)) + beyond);
}

}  // namespace

bool sweep_point(const Sweep& sweep, const geometry::Corners& c, const Vector3d& normal,
                 std::int32_t slot, double end, SweepHit& hit) noexcept {
  const double h = sweep.skin.thickness;
  const double s1 = normal.dot(c[1] - c[0]), s2 = normal.dot(c[2] - c[0]);
  const double low = std::min({0.0, s1, s2}), high = std::max({0.0, s1, s2});
  const double at = normal.dot(sweep.from - c[0]), rate = normal.dot(sweep.move);
  const double then = at + rate * end;
  if ((at > high + h && then > high + h) || (at < low - h && then < low - h)) {
    return false;
  }
  Clip clip(sweep, end);
  if (!clip.cut(normal, c[0], high + h) || !clip.cut(-normal, c[0], h - low) ||
      !cut_sides(c, normal, 0.5 * h, clip)) {
    return false;
  }
  hit.plane.slot = slot;
  hit.plane.curved = false;
  if (clip.entered()) {
    clip.stop(h, hit);
    return true;
  }
  // It began inside of the prism: a start put it there, or the skin has grown with the path. It may
  // go on if it is clearly on one side and stays there, or if it goes straight away.
  const double side = at >= 0.5 * (low + high) ? 1.0 : -1.0;
  const double off = side > 0.0 ? at - high : low - at;
  const double leaving = side * rate;
  if ((leaving >= 0.0 && off > h / 32.0) || leaving > 0.25 * sweep.move.norm()) {
    return false;
  }
  hit.t = 0.0;
  hit.plane.normal = side * normal;
  hit.plane.point = c[0];
  hit.plane.level = (side > 0.0 ? high : -low) + sweep.skin.rest();
  return true;
}

}  // namespace haptrial::contact
