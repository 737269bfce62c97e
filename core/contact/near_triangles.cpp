#include "core/contact/near_triangles.h"

#include <algorithm>
#include <cmath>

#include "core/geometry/mesh/triangle_distance.h"

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

/// The part of a move until which nothing can be met that the list does not have; negative: none.
double NearTriangles::listed_part(const Sweep& sweep, double length) const noexcept {
  const double within = covered_ - radius_ - 2.0 * sweep.skin.rest();
  if (!(within > 0.0)) {
    return -1.0;
  }
  const Eigen::Vector3d from = sweep.from - centre_;
  const double inside = within * within - from.squaredNorm();
  if (inside <= 0.0) {
    return -1.0;
  }
  if ((from + sweep.move).squaredNorm() <= within * within) {
    return 1.0;
  }
  // Distance at which the move leaves the ball.
  const double along = from.dot(sweep.move) / length;
  const double root = std::sqrt(along * along + inside);
  const double ahead = along > 0.0 ? inside / (root + along) : root - along;
  return std::min(ahead / length, 1.0);
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

namespace {

/// Middle of a list: it reaches farther ahead than behind.
Eigen::Vector3d middle_ahead(const Sweep& sweep, double reach) {
  constexpr double kLead = 0.6;
  const double length = sweep.move.norm();
  return length > 0.0 ? Eigen::Vector3d(sweep.from + kLead * reach / length * sweep.move)
                      : sweep.from;
}

}  // namespace

/// The next list reaches farther after a short list, and less far after a long one.
void NearTriangles::adapt_reach(int count) noexcept {
  const bool point = radius_ == 0.0;
  // Triangles that lie around the proxy as it is are listed however near the reach is.
  constexpr double kLeastReach = 1.0;  // of the typical edge
  const bool many = count > (point ? kMany : kManyOfSphere);
  if (count < 0 || (many && reach_ > kLeastReach * surface_->typical_edge())) {
    reach_ *= 0.6;
  } else if (count < (point ? kFew : kFewOfSphere) && reach_ < 4.0 * surface_->typical_edge()) {
    reach_ *= 1.2;
  }
}

bool NearTriangles::gather(const Sweep& sweep, double reach) noexcept {
  const double around = radius_ + 2.0 * sweep.skin.rest();
  const Eigen::Vector3d middle = middle_ahead(sweep, reach);
  ++operations_.lists;
  const int count = surface_->gather(middle, around + reach, found_);
  adapt_reach(count);
  if (count < 0) {
    covered_ = -1.0;
    return false;
  }
  centre_ = middle;
  covered_ = around + reach;
  listed_.clear(centre_, covered_);
  for (int i = 0; i < count; ++i) {
    listed_.add(found_[i].slot, surface_->corners(found_[i].slot));
  }
  listed_.part_all(sweep.from);
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

/// Vector from the nearest point of a triangle; zero if that is where the point is.
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

/// First hit among the candidates that are tested one after the other.
struct NearTriangles::FirstMet {
  const Sweep& sweep;
  double length;  // of the move [m]
  double end;     // the part of the move that is looked at
  double limit;   // the part of it that is still of interest
  SweepHit& hit;
  bool met{false};
  int tested{0};
};

/// A few together: other planes first, which are cheaper than tests.
void NearTriangles::test(std::span<PartedTriangles::Candidate> few,
                         const PartedTriangles::Move& move, FirstMet& first) noexcept {
  const auto too_late = [&](const auto& c) { return first.end * c.t > first.limit; };
  few = few.first(std::remove_if(few.begin(), few.end(), too_late) - few.begin());
  for (const PartedTriangles::Candidate& candidate : few.first(listed_.part_anew(move, few))) {
    if (!too_late(candidate)) {
      test(candidate, first);
    }
  }
}

void NearTriangles::test(const PartedTriangles::Candidate& candidate, FirstMet& first) noexcept {
  SweepHit here;
  ++first.tested;
  if (!meets_listed(first.sweep, candidate.i, first.limit, here)) {
    return;
  }
  first.hit = first.met ? sooner(first.hit, here, first.length, first.sweep.skin.thickness) : here;
  first.met = true;
  // Candidates that are farther away stop it no sooner.
  first.limit = std::min(first.limit, first.hit.t + first.sweep.skin.rest() / first.length);
}

bool NearTriangles::first_listed(const Sweep& sweep, double end, double length,
                                 SweepHit& hit) noexcept {
  // A little more than the hull that is never entered.
  const double off = radius_ + 1.25 * sweep.skin.thickness;
  const PartedTriangles::Move move = listed_.in_list(sweep.from, end * sweep.move, off);
  const int count = listed_.within(move, candidates_);
  FirstMet first{sweep, length, end, end, hit};
  // The soonest first: most often they stop the proxy, and the others need not be looked at.
  constexpr int kSorted = 2 * PartedTriangles::kTogether;
  const auto sooner_of_two = [](const auto& a, const auto& b) { return a.t < b.t; };
  const auto last = candidates_.begin() + count;
  auto next = candidates_.begin();
  if (radius_ > 0.0 && count > 0) {  // what a sphere may meet first it most often does
    std::iter_swap(next, std::min_element(next, last, sooner_of_two));
    test(*next++, first);
  }
  while (next < last) {
    const auto stop = next + std::min<std::ptrdiff_t>(PartedTriangles::kTogether, last - next);
    if (next - candidates_.begin() < kSorted && !first.met) {
      std::partial_sort(next, stop, last, sooner_of_two);
    }
    test({next, stop}, move, first);
    next = stop;
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

/// @param part  receives how much of the move the list covers
NearTriangles::ListOutcome NearTriangles::look_through_list(const Sweep& sweep, double length,
                                                            double& part, SweepHit& hit) noexcept {
  part = std::max(0.0, listed_part(sweep, length));
  if (part > 0.0 && first_listed(sweep, part, length, hit)) {
    return ListOutcome::kMet;
  }
  return part == 1.0 ? ListOutcome::kFree : ListOutcome::kEnds;
}

bool NearTriangles::first_hit(const Sweep& sweep, SweepHit& hit, double& seen) noexcept {
  const double length = sweep.move.norm();
  seen = 1.0;
  ++operations_.sweeps;
  if (is_clear(sweep, length)) {
    return false;
  }
  double known = 0.0, part = 0.0;
  if (const ListOutcome listed = look_through_list(sweep, length, known, hit);
      listed != ListOutcome::kEnds) {
    return listed == ListOutcome::kMet;
  }
  // The rest of the move, from where the list ends.
  const double left = (1.0 - known) * length;
  const Sweep rest{sweep.from + known * sweep.move, (1.0 - known) * sweep.move, radius_,
                   sweep.skin};
  const auto of_move = [&](double t) { return known + (1.0 - known) * t; };
  // A point that goes far looks through the hierarchy anyway; a sphere that came far looks later.
  constexpr double kFar = 3.0, kCame = 0.5;  // of the next list's reach
  if (radius_ > 0.0 ? known * length < kCame * reach_ : left <= kFar * reach_) {
    list_around(rest);
    const ListOutcome listed = look_through_list(rest, left, part, hit);
    if (listed == ListOutcome::kMet) {
      hit.t = of_move(hit.t);
    }
    if (listed != ListOutcome::kEnds) {
      return listed == ListOutcome::kMet;
    }
  }
  if (radius_ > 0.0 && (known > 0.0 || part > 0.0)) {
    const double clear =
        clear_ - radius_ - 2.0 * sweep.skin.rest() - (sweep.from - clear_centre_).norm();
    seen = std::clamp(std::max(of_move(part), clear / length), 0.0, 1.0);
    return false;
  }
  if (!first_of_all(rest, hit)) {
    return false;
  }
  hit.t = of_move(hit.t);
  return true;
}

}  // namespace haptrial::contact
