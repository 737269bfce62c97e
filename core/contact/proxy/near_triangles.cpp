#include "core/contact/proxy/near_triangles.h"

#include <algorithm>
#include <cmath>

#include "core/geometry/triangle/triangle_distance.h"

namespace haptrial::contact {
namespace {

constexpr std::size_t kMostListed = 1024;
// A list of few may reach farther next time, one of many less far.
constexpr int kFew = 12, kMany = 48;
constexpr int kFewOfSphere = 24, kManyOfSphere = 70;

}  // namespace

NearTriangles::NearTriangles(const ContactSurface& surface, double radius)
    : surface_(&surface),
      radius_(radius),
      hulls_(surface),
      found_(kMostListed),
      listed_(kMostListed),
      candidates_(kMostListed),
      reach_(surface.typical_edge()) {}

void NearTriangles::forget() noexcept {
  covered_ = -1.0;
  clear_ = -1.0;
  reach_ = surface_->typical_edge();  // a start is the same whatever came before
  operations_ = {};
}

bool NearTriangles::meets(const Sweep& sweep, std::int32_t slot, SweepHit& hit) noexcept {
  ++operations_.triangles_tested;
  Eigen::Vector3d apart;
  return meets(sweep, slot, 1.0, hit, apart);
}

bool NearTriangles::meets(const Sweep& sweep, std::int32_t slot, double end, SweepHit& hit,
                          Eigen::Vector3d& apart) noexcept {
  const Hull& hull = hulls_.of(slot);
  return radius_ > 0.0 ? sweep_sphere(sweep, surface_->corners(slot), surface_->normal(slot), hull,
                                      end, hit, apart)
                       : sweep_point(sweep, hull, end, hit, apart);
}

bool NearTriangles::is_clear(const Sweep& sweep, double length) const noexcept {
  return clear_ > 0.0 &&
         (sweep.from - clear_centre_).norm() + length < clear_ - radius_ - 2.0 * sweep.skin.rest();
}

/// How far the proxy may go until something may be met that the list does not have.
double NearTriangles::left(const Sweep& sweep) const noexcept {
  return covered_ - radius_ - 2.0 * sweep.skin.rest() - (sweep.from - centre_).norm();
}

bool NearTriangles::list_around(const Sweep& sweep) noexcept {
  constexpr int kMostTried = 8;
  for (int tried = 0; tried < kMostTried; ++tried) {
    if (gather(sweep, reach_)) {
      return true;
    }
  }
  return false;
}

bool NearTriangles::gather(const Sweep& sweep, double reach) noexcept {
  const double around = radius_ + 2.0 * sweep.skin.rest();
  ++operations_.lists;
  const int count = surface_->gather(sweep.from, around + reach, found_);
  const bool point = radius_ == 0.0;
  // Triangles that lie around the proxy as it is are listed however near the reach is.
  constexpr double kLeastReach = 1.0;  // of the typical edge
  const bool many = count > (point ? kMany : kManyOfSphere);
  if (count < 0 || (many && reach_ > kLeastReach * surface_->typical_edge())) {
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
  covered_ = around + reach;
  listed_reach_ = reach;
  listed_.clear(centre_, covered_);
  for (int i = 0; i < count; ++i) {
    listed_.add(found_[i].slot, surface_->corners(found_[i].slot), sweep.from);
  }
  if (count == 0) {
    clear_centre_ = sweep.from;
    ++operations_.nearest_searches;
    clear_ = std::sqrt(surface_->bvh().closest(sweep.from).distance_squared);
  }
  return true;
}

namespace {

/// The sooner of two hits. Of two at the same place, to rounding, a face is the better one: the
/// edge of a triangle that lies in the same plane has a normal that is tilted towards it.
SweepHit sooner(const SweepHit& a, const SweepHit& b, double length, double same) {
  const bool together = std::abs(a.t - b.t) * length <= same;
  SweepHit first = together && a.plane.curved != b.plane.curved ? (a.plane.curved ? b : a)
                   : b.t < a.t                                  ? b
                                                                : a;
  constexpr double kOneDirection = 1.0 - 1e-12;
  if (together && a.plane.curved && b.plane.curved &&
      a.plane.normal.dot(b.plane.normal) > kOneDirection) {
    first.plane.beside = first.plane.slot == a.plane.slot ? b.plane.slot : a.plane.slot;
  }
  first.t = std::min(a.t, b.t);
  return first;
}

}  // namespace

namespace {

/// From the nearest point of a triangle; zero if that is where the point is.
Eigen::Vector3d away_from_triangle(const Eigen::Vector3d& at, const geometry::Corners& c) {
  const geometry::ClosestPoint nearest = geometry::closest_on_triangle(at, c[0], c[1], c[2]);
  const double distance = std::sqrt(nearest.distance_squared);
  return distance > 0.0 ? Eigen::Vector3d((at - nearest.point) / distance)
                        : Eigen::Vector3d(Eigen::Vector3d::Zero());
}

}  // namespace

bool NearTriangles::meets_listed(const Sweep& sweep, int i, double end, SweepHit& hit) noexcept {
  const std::int32_t slot = listed_.slot(i);
  Eigen::Vector3d apart = Eigen::Vector3d::Zero();
  const bool met = meets(sweep, slot, end, hit, apart);
  if (!met && apart.isZero(0.0)) {
    apart = away_from_triangle(sweep.from, surface_->corners(slot));
  }
  if (!apart.isZero(0.0)) {
    listed_.part(i, surface_->corners(slot), apart);
  }
  return met;
}

/// What is met first of the candidates that are tested one after the other.
struct NearTriangles::FirstMet {
  const Sweep& sweep;
  double length;  // of the move [m]
  double limit;   // the part of the move that is still of interest
  SweepHit& hit;
  bool met{false};
  int tested{0};
};

void NearTriangles::test(const PartedTriangles::Candidate& candidate, FirstMet& first) noexcept {
  SweepHit here;
  ++first.tested;
  if (!meets_listed(first.sweep, candidate.i, first.limit, here)) {
    return;
  }
  first.hit = first.met ? sooner(first.hit, here, first.length, first.sweep.skin.thickness) : here;
  first.met = true;
  // What is farther away stops it no sooner.
  first.limit = std::min(first.limit, first.hit.t + first.sweep.skin.rest() / first.length);
}

bool NearTriangles::first_listed(const Sweep& sweep, double end, double length,
                                 SweepHit& hit) noexcept {
  // A little more than the hull that is never entered.
  const double off = radius_ + 1.25 * sweep.skin.thickness;
  const int count = listed_.within(sweep.from, end * sweep.move, off, candidates_);
  FirstMet first{sweep, length, end, hit};
  // The soonest first: most often it stops the proxy, and the others need not be looked at.
  constexpr int kPicked = 4;
  int next = 0;
  for (; next < std::min(kPicked, count) && !first.met; ++next) {
    const auto soonest = std::min_element(candidates_.begin() + next, candidates_.begin() + count,
                                          [](const auto& a, const auto& b) { return a.t < b.t; });
    std::swap(candidates_[next], *soonest);
    test(candidates_[next], first);
  }
  for (; next < count; ++next) {
    if (end * candidates_[next].t <= first.limit) {
      test(candidates_[next], first);
    }
  }
  operations_.triangles_tested += first.tested;
  operations_.triangles_passed += listed_.size() - first.tested;
  return first.met;
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
  double ahead = left(sweep);
  const auto listed = [&] { return covered_ > 0.0 && ahead > 0.0; };
  if (listed()) {
    const double part = std::min(1.0, ahead / length);
    if (first_listed(sweep, part, length, hit)) {
      return true;
    }
    if (part == 1.0) {
      return false;
    }
  }
  // A point that goes far looks through the hierarchy anyway.
  constexpr double kFar = 3.0;  // of the next list's reach
  const bool leaves = radius_ == 0.0 && length > kFar * reach_;
  if (!leaves && (ahead < 0.5 * listed_reach_ || covered_ < 0.0)) {
    list_around(sweep);
    ahead = left(sweep);
    if (listed() && first_listed(sweep, std::min(1.0, ahead / length), length, hit)) {
      return true;
    }
  }
  if (listed() && ahead >= length) {
    return false;
  }
  if (radius_ > 0.0 && listed()) {
    const double clear =
        clear_ - radius_ - 2.0 * sweep.skin.rest() - (sweep.from - clear_centre_).norm();
    seen = std::clamp(std::max(ahead, clear) / length, 0.0, 1.0);
    return false;
  }
  return first_of_all(sweep, hit);
}

}  // namespace haptrial::contact
