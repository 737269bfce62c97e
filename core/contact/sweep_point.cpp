#include <algorithm>

#include "core/contact/sweep.h"

namespace haptrial::contact {
namespace {

using Eigen::Vector3d;

/// Distance at which a move enters a hull with its skin, and the plane that it passes; -1: it
/// begins inside.
struct Entry {
  double t{-1.0};
  int plane{-1};
};

/// @returns false if the move misses the hull.
bool clip(const Hull::Heights& heights, double h, Entry& entry) {
  double leave = 1.0;
  for (int k = 0; k < Hull::kPlanes; ++k) {
    const double above = heights.at[k] - Hull::wider(k, h), rate = heights.gain[k];
    if (above > 0.0) {
      if (rate >= 0.0) {
        return false;
      }
      const double t = -above / rate;
      if (t > entry.t) {
        entry = {t, k};
      }
    } else if (-above < leave * rate) {
      leave = -above / rate;
    }
  }
  return entry.t <= leave;
}

}  // namespace

bool sweep_point(const Sweep& sweep, const Hull& hull, double end, SweepHit& hit,
                 Vector3d& apart) noexcept {
  const double h = sweep.skin.thickness;
  const Hull::Heights heights = hull.heights(sweep.from, end * sweep.move);
  if (Hull::parted(heights, h, 0.5 * h)) {
    apart = hull.farthest(heights);
    return false;
  }
  Entry entry;
  if (!clip(heights, h, entry)) {
    return false;
  }
  hit.plane.slot = hull.slot;
  hit.plane.curved = false;
  hit.plane.point = hull.origin;
  if (entry.plane >= 0) {
    const int k = entry.plane;
    hit.plane.normal = hull.out(k);
    hit.plane.level = hull.level[k] + Hull::wider(k, h) + h;
    const double height = heights.at[k] - Hull::wider(k, h) - h, rate = heights.gain[k];
    hit.t = end * std::clamp(-height / rate, 0.0, entry.t);
    return true;
  }
  // The point began inside of the hull: a start put it there, or the skin has grown with the path.
  // It may go on if it is clearly on one side and stays there, or if it goes straight away.
  const int side = heights.at[0] >= heights.at[1] ? 0 : 1;
  const double off = heights.at[side], leaving = heights.gain[side];
  if ((leaving >= 0.0 && off > h / 32.0) || leaving > 0.25 * end * sweep.move.norm()) {
    return false;
  }
  hit.t = 0.0;
  hit.plane.normal = hull.out(side);
  hit.plane.level = hull.level[side] + sweep.skin.rest();
  return true;
}

}  // namespace haptrial::contact
