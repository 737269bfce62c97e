#include "core/contact/proxy/near_triangles.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace haptrial::contact {
namespace {

constexpr std::size_t kMostListed = 1024;
constexpr int kBlock = 8;  // entries of the list that are passed over together
// A list of few may reach farther next time, one of many less far. A sphere looks at most of its
// list but once.
constexpr int kFew = 12, kMany = 48;
constexpr int kFewOfSphere = 60, kManyOfSphere = 200;

}  // namespace

NearTriangles::NearTriangles(const ContactSurface& surface, double radius)
    : surface_(&surface),
      radius_(radius),
      found_(kMostListed),
      listed_(kMostListed),
      clear_until_(kMostListed + kBlock),
      reach_(surface.typical_edge()) {}

void NearTriangles::forget() noexcept {
  count_ = 0;
  covered_ = -1.0;
  clear_ = -1.0;
  reach_ = surface_->typical_edge();  // a start is the same whatever came before
  operations_ = {};
}

bool NearTriangles::meets(const Sweep& sweep, std::int32_t slot, SweepHit& hit) noexcept {
  ++operations_.triangles_tested;
  if (radius_ > 0.0) {
    SphereGap gap;
    return sweep_sphere(sweep, surface_->corners(slot), surface_->normal(slot), slot, 1.0, hit,
                        gap);
  }
  return sweep_point(sweep, surface_->corners(slot), surface_->normal(slot), slot, 1.0, hit);
}

bool NearTriangles::is_clear(const Sweep& sweep, double length) noexcept {
  return clear_ > 0.0 &&
         (sweep.from - clear_centre_).norm() + length < clear_ - radius_ - 2.0 * sweep.skin.rest();
}

/// Makes a list that covers the move, or its beginning.
bool NearTriangles::collect(const Sweep& sweep, double length) noexcept {
  const double apart = (sweep.from - centre_).norm();
  if (covered_ > 0.0 && (apart + length < covered_ || apart < 0.5 * covered_)) {
    return true;
  }
  for (int attempt = 0; attempt < 8; ++attempt) {
    if (list_around(sweep, reach_)) {
      return true;
    }
  }
  return false;
}

bool NearTriangles::list_around(const Sweep& sweep, double reach) noexcept {
  const double around = radius_ + 2.0 * sweep.skin.rest();
  ++operations_.lists;
  const int count = surface_->gather(sweep.from, around + reach, found_);
  const bool point = radius_ == 0.0;
  if (count < 0 || count > (point ? kMany : kManyOfSphere)) {
    reach_ *= 0.6;
  } else if (count < (point ? kFew : kFewOfSphere) &&
             reach_ < 4.0 * surface_->typical_edge() + radius_) {
    reach_ *= 1.2;
  }
  if (count < 0) {
    covered_ = -1.0;
    return false;
  }
  centre_ = sweep.from;
  covered_ = reach;
  count_ = count;
  path_ = 0.0;
  for (int i = 0; i < count; ++i) {
    Known& known = listed_[i];
    clear_until_[i] = found_[i].distance - around;
    known.slot = found_[i].slot;
    const geometry::Corners& c = surface_->corners(known.slot);
    known.centre = (c[0] + c[1] + c[2]) / 3.0;
    known.normal = surface_->normal(known.slot);
    double square = 0.0;
    known.low = known.high = 0.0;
    for (const Eigen::Vector3d& corner : c) {
      const Eigen::Vector3d out = corner - known.centre;
      const double height = known.normal.dot(out);
      square = std::max(square, out.squaredNorm());
      known.low = std::min(known.low, height);
      known.high = std::max(known.high, height);
    }
    known.ball = std::sqrt(square);
    known.axis.setZero();
    known.level = std::numeric_limits<double>::infinity();
  }
  std::fill_n(clear_until_.begin() + count, kBlock, std::numeric_limits<double>::infinity());
  if (count == 0) {
    clear_centre_ = sweep.from;
    ++operations_.nearest_searches;
    clear_ = std::sqrt(surface_->bvh().closest(sweep.from).distance_squared);
  }
  return true;
}

namespace {

/// Of two hits at the same place, to rounding, a face is the better one: the edge of a triangle
/// that lies in the same plane has a normal that is tilted towards it.
bool is_sooner(const SweepHit& here, const SweepHit& other, double length, double same) {
  if (std::abs(here.t - other.t) * length <= same && here.plane.curved != other.plane.curved) {
    return other.plane.curved;
  }
  return here.t < other.t;
}

}  // namespace

/// False only if the proxy cannot meet the triangle on this part of its move.
bool NearTriangles::can_meet(const Sweep& sweep, int i, double end, double length) noexcept {
  const Known& known = listed_[i];
  const double rest = 2.0 * sweep.skin.rest();
  if (radius_ > 0.0) {
    const double height = known.axis.dot(sweep.from) - known.level;
    if (std::min(height, height + end * known.axis.dot(sweep.move)) > radius_ + rest) {
      return false;
    }
  }
  const Eigen::Vector3d from = sweep.from - known.centre;
  const double apart = from.norm() - known.ball - radius_ - rest;
  if (apart > end * length) {
    clear_until_[i] = path_ + apart;
    return false;
  }
  const double at = known.normal.dot(from), then = at + end * known.normal.dot(sweep.move);
  const double off = radius_ + (radius_ > 0.0 ? sweep.skin.rest() : 1.25 * sweep.skin.thickness);
  return !(std::min(at, then) > known.high + off || std::max(at, then) < known.low - off);
}

bool NearTriangles::meets_listed(const Sweep& sweep, int i, double end, SweepHit& hit) noexcept {
  Known& known = listed_[i];
  const geometry::Corners& corners = surface_->corners(known.slot);
  if (radius_ == 0.0) {
    return sweep_point(sweep, corners, surface_->normal(known.slot), known.slot, end, hit);
  }
  SphereGap gap;
  const bool met =
      sweep_sphere(sweep, corners, surface_->normal(known.slot), known.slot, end, hit, gap);
  clear_until_[i] = path_ + gap.distance - radius_ - 2.0 * sweep.skin.rest();
  known.axis = gap.away;
  known.level = std::max({gap.away.dot(corners[0]), gap.away.dot(corners[1]),  //
                          gap.away.dot(corners[2])});
  return met;
}

bool NearTriangles::first_listed(const Sweep& sweep, double end, double length,
                                 SweepHit& hit) noexcept {
  bool met = false;
  int tested = 0;
  double until = path_ + end * length;
  for (int first = 0; first < count_; first += kBlock) {
    bool any = false;
    for (int i = first; i < first + kBlock; ++i) {
      any |= clear_until_[i] <= until;
    }
    for (int i = first; any && i < std::min(first + kBlock, count_); ++i) {
      if (clear_until_[i] > until || !can_meet(sweep, i, end, length)) {
        continue;
      }
      SweepHit here;
      ++tested;
      if (!meets_listed(sweep, i, end, here) ||
          (met && !is_sooner(here, hit, length, sweep.skin.thickness))) {
        continue;
      }
      const double t = met ? std::min(hit.t, here.t) : here.t;
      hit = here;
      hit.t = t;
      met = true;
      // What is farther away stops it no sooner.
      until = path_ + t * length + sweep.skin.rest();
      end = std::min(end, t + sweep.skin.rest() / length);
    }
  }
  operations_.triangles_tested += tested;
  operations_.triangles_passed += count_ - tested;
  return met;
}

namespace {

struct Search {
  NearTriangles* near;
  const Sweep* sweep;
  SweepHit hit;
  bool met;
};

double look_at(void* context, std::int32_t slot) {
  auto& search = *static_cast<Search*>(context);
  SweepHit here;
  if (search.near->meets(*search.sweep, slot, here) && (!search.met || here.t < search.hit.t)) {
    search.hit = here;
    search.met = true;
  }
  return search.met ? search.hit.t : 1.0;
}

}  // namespace

bool NearTriangles::first_of_all(const Sweep& sweep, SweepHit& hit) noexcept {
  ++operations_.long_sweeps;
  Search search{this, &sweep, {}, false};
  surface_->along(sweep.from, sweep.move, radius_ + 2.0 * sweep.skin.rest(), look_at, &search);
  hit = search.hit;
  return search.met;
}

bool NearTriangles::first_hit(const Sweep& sweep, SweepHit& hit, double& seen) noexcept {
  const double length = sweep.move.norm();
  seen = 1.0;
  ++operations_.sweeps;
  if (is_clear(sweep, length)) {
    return false;
  }
  const bool listed = collect(sweep, length);
  const double left = covered_ - (sweep.from - centre_).norm();
  if (listed && length < left) {
    return first_listed(sweep, 1.0, length, hit);
  }
  // A long move most often meets something near.
  const double part = left / length;
  if (part > 0.0 && part < 1.0 &&
      (first_listed(sweep, 0.1 * part, length, hit) || first_listed(sweep, part, length, hit))) {
    return true;
  }
  if (radius_ > 0.0 && listed) {
    const double clear =
        clear_ - radius_ - 2.0 * sweep.skin.rest() - (sweep.from - clear_centre_).norm();
    seen = std::clamp(std::max(left, clear) / length, 0.0, 1.0);
    return false;
  }
  return first_of_all(sweep, hit);
}

}  // namespace haptrial::contact
