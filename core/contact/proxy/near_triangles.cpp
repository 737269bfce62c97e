#include "core/contact/proxy/near_triangles.h"

#include <algorithm>
#include <cmath>

namespace haptrial::contact {
namespace {

constexpr std::size_t kMostListed = 384;
// A list of this many is short enough; one of more than the other is made smaller next time.
constexpr int kFew = 12;
constexpr int kMany = 48;

}  // namespace

NearTriangles::NearTriangles(const ContactSurface& surface, double radius)
    : surface_(&surface),
      radius_(radius),
      found_(kMostListed),
      listed_(kMostListed),
      reach_(surface.typical_edge()) {}

void NearTriangles::forget() noexcept {
  count_ = 0;
  covered_ = -1.0;
  clear_ = -1.0;
}

bool NearTriangles::meets(const Sweep& sweep, std::int32_t slot, SweepHit& hit) const noexcept {
  if (radius_ > 0.0) {
    double distance = 0.0;
    return sweep_sphere(sweep, surface_->corners(slot), surface_->normal(slot), slot, 1.0, hit,
                        distance);
  }
  return sweep_point(sweep, surface_->corners(slot), surface_->normal(slot), slot, 1.0, hit);
}

bool NearTriangles::is_clear(const Sweep& sweep, double length) noexcept {
  return clear_ > 0.0 &&
         (sweep.from - clear_centre_).norm() + length < clear_ - radius_ - 2.0 * sweep.skin.rest();
}

/// Makes a list that covers the move, if one of sensible length can.
bool NearTriangles::collect(const Sweep& sweep, double length) noexcept {
  const double apart = (sweep.from - centre_).norm();
  if (covered_ > 0.0 && apart + length < covered_) {
    return true;
  }
  if (!(length < 8.0 * reach_)) {
    return false;
  }
  const double wanted = std::max(reach_, 2.0 * length);
  const double around = radius_ + 2.0 * sweep.skin.rest();
  const int count = surface_->gather(sweep.from, around + wanted, found_);
  if (count < 0 || count > kMany) {
    reach_ *= 0.6;
  } else if (count < kFew && reach_ < 4.0 * surface_->typical_edge() + radius_) {
    reach_ *= 1.2;
  }
  if (count < 0) {
    covered_ = -1.0;
    return false;
  }
  centre_ = sweep.from;
  covered_ = wanted;
  count_ = count;
  path_ = 0.0;
  for (int i = 0; i < count; ++i) {
    listed_[i] = {found_[i].distance - around, found_[i].slot};
  }
  if (count == 0) {
    clear_centre_ = sweep.from;
    clear_ = std::sqrt(surface_->bvh().closest(sweep.from).distance_squared);
  }
  return true;
}

bool NearTriangles::first_listed(const Sweep& sweep, double end, double length,
                                 SweepHit& hit) noexcept {
  bool met = false;
  const double until = path_ + end * length;
  for (int i = 0; i < count_; ++i) {
    Known& known = listed_[i];
    if (known.clear_until > until) {
      continue;
    }
    SweepHit here;
    bool meets_it = false;
    if (radius_ > 0.0) {
      double distance = 0.0;
      meets_it = sweep_sphere(sweep, surface_->corners(known.slot), surface_->normal(known.slot),
                              known.slot, end, here, distance);
      known.clear_until = path_ + distance - radius_ - 2.0 * sweep.skin.rest();
    } else {
      meets_it = sweep_point(sweep, surface_->corners(known.slot), surface_->normal(known.slot),
                             known.slot, end, here);
    }
    if (meets_it && (!met || here.t < hit.t)) {
      hit = here;
      met = true;
    }
  }
  return met;
}

namespace {

struct Search {
  const NearTriangles* near;
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

bool NearTriangles::first_of_all(const Sweep& sweep, SweepHit& hit) const noexcept {
  Search search{this, &sweep, {}, false};
  surface_->along(sweep.from, sweep.move, radius_ + 2.0 * sweep.skin.rest(), look_at, &search);
  hit = search.hit;
  return search.met;
}

bool NearTriangles::first_hit(const Sweep& sweep, SweepHit& hit) noexcept {
  const double length = sweep.move.norm();
  if (is_clear(sweep, length)) {
    return false;
  }
  if (collect(sweep, length)) {
    return first_listed(sweep, 1.0, length, hit);
  }
  // A long move: what it meets may be near.
  if (covered_ > 0.0) {
    const double part = (covered_ - (sweep.from - centre_).norm()) / length;
    if (part > 0.0 && part < 1.0 && first_listed(sweep, part, length, hit)) {
      return true;
    }
  }
  return first_of_all(sweep, hit);
}

}  // namespace haptrial::contact
