#include "core/contact/proxy.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <stdexcept>

#include "core/contact/arc.h"

namespace haptrial::contact {
namespace {

using Eigen::Vector3d;

const ProxyOptions& checked(const ProxyOptions& options) {
  const Friction& f = options.friction;
  if (!(options.radius >= 0.0) || !std::isfinite(options.radius)) {
    throw std::invalid_argument("radius: allowed: finite, 0 or more");
  }
  if (!(f.dynamic_friction >= 0.0) || !std::isfinite(f.static_friction)) {
    throw std::invalid_argument("dynamic_friction: allowed: finite, 0 or more");
  }
  if (!(f.static_friction >= f.dynamic_friction)) {
    throw std::invalid_argument("static_friction: allowed: at least dynamic_friction");
  }
  if (options.most_steps < 1 || options.most_steps > 48) {
    throw std::invalid_argument("most_steps: allowed: 1 to 48");
  }
  if (options.most_work < 1) {
    throw std::invalid_argument("most_work: allowed: 1 or more");
  }
  return options;
}

/// Planes that the proxy touches do not stop a move that leads off them.
bool leads_off(const ContactPlane& plane, const Vector3d& move) {
  return plane.normal.dot(move) >= 0.0;
}

}  // namespace

std::uint64_t work_of(const Operations& o, double radius) noexcept {
  constexpr std::uint64_t kPassed = 16;  // for one test
  constexpr std::uint64_t kList = 30, kLongSweep = 30, kOfSphere = 2;
  return (radius > 0.0 ? kOfSphere : 1) * o.triangles_tested + o.triangles_passed / kPassed +
         kList * o.lists + kLongSweep * o.long_sweeps;
}

/// State of one tick.
struct Proxy::Tick {
  Vector3d goal;
  Skin skin;
  double least;          // moves shorter than this are none [m]
  bool slipped{false};   // along a surface
  bool repeated{false};  // the last hit was a plane that is known: rounding is all that is left
  bool lifted{false};
  int faces_ended{0};  // at which a move was cut

  double enough() const { return 4.0 * least; }  // ways that are no longer lead nowhere [m]
  double tolerance() const { return 0.25 * skin.thickness; }  // of a plane [m]
};

Proxy::Proxy(const ContactSurface& surface, const ProxyOptions& options)
    : surface_(&surface), options_(checked(options)), near_(surface, options.radius) {}

void Proxy::start(const Vector3d& at) noexcept {
  near_.forget();
  planes_.clear();
  before_.clear();
  corner_.forget();
  slipping_ = false;
  state_ = {};
  if (at.allFinite()) {
    state_.position = at;
  }
  way_[0] = state_.position;
  way_length_ = 1;
}

PlaneSolution Proxy::solve(const Tick& tick, const Vector3d& wish) noexcept {
  const PlaneSolution solution = planes_.solve(state_.position, wish, tick.tolerance());
  near_.operations().plane_solutions += solution.tried;
  return solution;
}

void Proxy::step_to(const Vector3d& at) noexcept {
  state_.position = at;
  way_[way_length_++] = at;
}

/// Steps back from the last corner of the way to the one before: this way was tried and is not
/// taken.
void Proxy::step_back(const Vector3d& to) noexcept {
  if (state_.position != to) {
    state_.position = to;
    --way_length_;
  }
}

/// Moves until something is met, which becomes a plane, or as far as was looked.
/// @returns false at the end of the move.
bool Proxy::go(Tick& tick, const Vector3d& move) noexcept {
  const Sweep sweep{state_.position, move, options_.radius, tick.skin};
  SweepHit hit;
  bool met = false;
  const double length = move.norm();
  for (int i = 0; i < before_.size() && !met; ++i) {
    if (planes_.has(before_[i]) || leads_off(before_[i], move)) {
      continue;  // the move heeds it
    }
    // Triangles that held the proxy a moment ago most often still do; then it is not moved at all.
    met = near_.meets(sweep, before_[i].slot, hit) && hit.t * length <= 2.0 * tick.least &&
          !hit.plane.curved;
    hit.t = 0.0;
  }
  double seen = 1.0;
  if (!met) {
    met = near_.first_hit(sweep, hit, seen);
  }
  if (!met) {
    step_to(state_.position + seen * move);
    return seen < 1.0;  // the same planes lead on
  }
  if (hit.t > 0.0) {
    step_to(state_.position + hit.t * move);
  }
  tick.repeated = !planes_.add(hit.plane);
  return true;
}

/// The part of a move along surfaces that friction leaves.
Vector3d Proxy::allowed_by_friction(const PlaneSolution& solution, bool& sticks) const noexcept {
  const Friction& f = options_.friction;
  sticks = false;
  if (solution.count == 0 || f.static_friction == 0.0) {
    return solution.move;
  }
  const double length = solution.move.norm();
  const double pressure = std::max(solution.pressure(), 0.0);
  if (length <= (slipping_ ? f.dynamic_friction : f.static_friction) * pressure) {
    sticks = true;
    return Vector3d::Zero();
  }
  return solution.move * std::max(0.0, 1.0 - f.dynamic_friction * pressure / length);
}

/// A plane reaches beyond its triangle. With friction it matters where the proxy leaves the face,
/// as the way on the next one depends on it; without, every way leads to the same place.
Vector3d Proxy::until_face_ends(Tick& tick, const PlaneSolution& solution,
                                const Vector3d& move) const noexcept {
  constexpr int kMostCut = 4;  // a tick; each takes two steps
  if (options_.friction.static_friction == 0.0 || solution.count != 1 ||
      tick.faces_ended == kMostCut || planes_[solution.active[0]].curved) {
    return move;
  }
  const std::int32_t slot = planes_[solution.active[0]].slot;
  const double beyond = 2.0 * tick.skin.rest();  // of the hull around the face, which is wider
  const double part =
      face_end(surface_->corners(slot), surface_->normal(slot), state_.position, move, beyond);
  tick.faces_ended += part < 1.0;
  return part * move;
}

/// A proxy at the very limit of its skin is set off from what is around it.
void Proxy::lift(Tick& tick) noexcept {
  Vector3d away = Vector3d::Zero();
  for (int i = 0; i < planes_.size(); ++i) {
    away += planes_[i].normal;
  }
  const double length = away.norm();
  tick.repeated = false;
  tick.lifted = true;
  planes_.clear();
  if (length > 0.1) {
    go(tick, tick.skin.thickness / length * away);
    planes_.clear();
    tick.repeated = false;
  }
}

/// Whether one of the known triangles stops a sweep at once.
bool Proxy::blocked_at_once(const Sweep& sweep, double length, double enough) noexcept {
  SweepHit hit;
  for (int i = 0; i < planes_.size(); ++i) {
    if (!leads_off(planes_[i], sweep.move) && near_.meets(sweep, planes_[i].slot, hit) &&
        hit.t * length <= enough) {
      return true;
    }
  }
  return false;
}

/// Goes as if only some of the planes were there, if that leads anywhere.
bool Proxy::leave_on(const Tick& tick, std::span<const int> which) noexcept {
  constexpr int kMostTried = 8;
  const Vector3d wish = tick.goal - state_.position;
  const double enough = tick.enough();
  const PlaneSolution solution = planes_.solve_on(which, state_.position, wish);
  near_.operations().plane_solutions += 1;
  bool sticks = false;
  const Vector3d move = allowed_by_friction(solution, sticks);
  const double square = move.squaredNorm();
  if (!solution.solved || !(square > enough * enough) ||
      !(solution.residual.squaredNorm() < wish.squaredNorm())) {
    return false;
  }
  const double length = std::sqrt(square);
  const Sweep sweep{state_.position, move, options_.radius, tick.skin};
  if (blocked_at_once(sweep, length, enough)) {
    return false;
  }
  SweepHit hit;
  double seen = 1.0;
  const bool met = near_.first_hit(sweep, hit, seen);
  const double free = met ? hit.t : seen;
  if (free * length > enough) {
    step_to(state_.position + free * move);
    return true;
  }
  if (met && planes_.size() < kMostTried) {
    planes_.add(hit.plane);  // the way may go along this one
  }
  return false;
}

/// Planes reach beyond their triangles: where they stop the proxy, one or two of them alone may let
/// it pass beside the others.
bool Proxy::find_way_out(const Tick& tick) noexcept {
  const int known = planes_.size();
  for (int j = 0; j < planes_.size(); ++j) {
    if (leave_on(tick, std::array{j})) {
      return true;
    }
    for (int i = 0; i < j && planes_.size() > 2; ++i) {
      if (leave_on(tick, std::array{i, j})) {
        return true;
      }
    }
  }
  if (options_.radius == 0.0) {
    corner_.set(planes_, state_.position, tick.skin);
  }
  planes_.keep_first(known);
  return false;
}

/// Whether a point stays at a corner, as every way on from there is stopped as it was before.
bool Proxy::still_held(Tick& tick) noexcept {
  if (!corner_.known(tick.skin)) {
    return false;
  }
  const Vector3d wish = tick.goal - state_.position;
  const PlaneSolution solution = solve(tick, wish);
  bool sticks = false;
  if (solution.count < 3 || allowed_by_friction(solution, sticks).norm() > tick.least ||
      !corner_.holds(wish, tick.enough(), near_)) {
    return false;
  }
  state_.settled = true;
  rest(tick, solution);
  return true;
}

/// @returns whether nothing was in the way of the two tangents to a direction; else that becomes
/// one that is to be tried next.
bool Proxy::take_tangents(const Tick& tick, const Arc& arc, Vector3d& to) noexcept {
  const Vector3d start = state_.position;
  for (const Vector3d& place : {arc.corner(to), arc.end(to)}) {
    SweepHit hit;
    double seen = 1.0;
    const Vector3d move = place - state_.position;
    const bool met =
        near_.first_hit({state_.position, move, options_.radius, tick.skin}, hit, seen);
    if (met || seen < 1.0) {
      // The arc ends where the face beside the edge begins.
      to = met ? arc.across(hit.plane.normal) : (arc.from + to).normalized();
      step_back(start);
      return false;
    }
    step_to(place);
  }
  return true;
}

/// A sphere that touches one edge or corner goes to where the goal is straight behind it.
bool Proxy::go_round(Tick& tick, const PlaneSolution& solution) noexcept {
  const std::optional<Arc> arc =
      arc_round(*surface_, planes_[solution.active[0]], state_.position, tick.goal,
                options_.friction.dynamic_friction, tick.least);
  if (!arc) {
    return false;
  }
  constexpr int kMostTried = 4;
  Vector3d to = arc->first;
  for (int tried = 0; tried < kMostTried && arc->leads_on(to); ++tried) {
    if (take_tangents(tick, *arc, to)) {
      forget_planes();
      return true;
    }
  }
  return false;
}

void Proxy::rest(Tick& tick, const PlaneSolution& solution) noexcept {
  const Friction& f = options_.friction;
  state_.pushed = solution.residual;
  state_.planes = 0;
  state_.pressure = solution.solved ? std::max(solution.pressure(), 0.0) : solution.residual.norm();
  for (int i = 0; i < solution.count; ++i) {
    const ContactPlane& plane = planes_[solution.active[i]];
    state_.triangles[state_.planes] = surface_->triangle(plane.slot);
    state_.push[state_.planes] = solution.push[i];
    state_.normals[state_.planes] = plane.normal;
    ++state_.planes;
  }
  state_.dragged.setZero();
  if (f.static_friction > 0.0 && solution.count > 0) {
    const double most = (tick.slipped ? f.dynamic_friction : f.static_friction) * state_.pressure;
    const double length = solution.move.norm();
    state_.dragged = -solution.move * (length > most ? most / length : 1.0);
  }
  slipping_ = tick.slipped;
  const bool touches = solution.count > 0 || !solution.solved;
  state_.state = !touches                                   ? ContactState::kFree
                 : f.static_friction == 0.0 || tick.slipped ? ContactState::kSlip
                                                            : ContactState::kStick;
}

/// The planes were left behind: what was met on the way is found anew.
void Proxy::forget_planes() noexcept {
  before_ = planes_;
  planes_.clear();
}

/// Nothing moves any more. @returns whether that is so to the end.
bool Proxy::come_to_rest(Tick& tick, const PlaneSolution& solution, bool sticks) noexcept {
  if (tick.repeated && !tick.lifted) {
    lift(tick);
    return false;
  }
  if (!sticks && options_.ways_out && planes_.size() > 1 && find_way_out(tick)) {
    tick.slipped = slipping_ = true;
    tick.repeated = false;
    forget_planes();
    return false;
  }
  state_.settled = true;
  rest(tick, solution);
  return true;
}

/// One step of a tick. @returns whether it was the last.
bool Proxy::advance(Tick& tick) noexcept {
  const Vector3d wish = tick.goal - state_.position;
  const PlaneSolution solution = solve(tick, wish);
  bool sticks = false;
  const Vector3d move = allowed_by_friction(solution, sticks);
  if (move.norm() <= tick.least || tick.repeated) {
    return come_to_rest(tick, solution, sticks);
  }
  if (solution.count > 0) {
    tick.slipped = slipping_ = true;
  }
  const bool arc = options_.arcs && options_.radius > 0.0 && solution.count == 1 &&
                   planes_[solution.active[0]].curved;
  if ((arc && go_round(tick, solution)) || go(tick, until_face_ends(tick, solution, move))) {
    return false;
  }
  if (solution.count > 0) {
    forget_planes();
    return false;
  }
  state_.position = way_[way_length_ - 1] = tick.goal;
  state_.settled = true;
  planes_.clear();
  before_.clear();
  rest(tick, solve(tick, Vector3d::Zero()));
  return true;
}

/// The tick's work is used up: what held the proxy last is taken to hold it.
void Proxy::break_off(Tick& tick) noexcept {
  if (planes_.size() == 0) {
    planes_ = before_;
  }
  const Vector3d wish = tick.goal - state_.position;
  PlaneSolution solution = solve(tick, wish);
  if (solution.count == 0) {
    solution.solved = false;
    solution.move.setZero();
    solution.residual = -wish;
  }
  rest(tick, solution);
}

const ProxyState& Proxy::follow(const Vector3d& tool) noexcept {
  if (!tool.allFinite()) {
    return state_;
  }
  const double magnitude =
      std::max({surface_->magnitude(), options_.radius, tool.cwiseAbs().maxCoeff(),
                state_.position.cwiseAbs().maxCoeff()});
  Tick tick{tool, Skin::of(magnitude), Skin::of(magnitude).rest()};
  ++near_.operations().ticks;
  way_[0] = state_.position;
  way_length_ = 1;
  if (still_held(tick)) {
    return state_;
  }
  corner_.forget();
  if (planes_.size() > 0) {
    before_ = planes_;
  }
  planes_.clear();
  state_.settled = false;
  const auto work = [&] { return work_of(near_.operations(), options_.radius); };
  const std::uint64_t enough = work() + static_cast<std::uint64_t>(options_.most_work);
  constexpr int kFewest = 4;  // three planes and the way along them: else it might stay
  for (int step = 0; step < options_.most_steps && (step < kFewest || work() < enough); ++step) {
    if (advance(tick)) {
      return state_;
    }
  }
  break_off(tick);
  return state_;
}

}  // namespace haptrial::contact
