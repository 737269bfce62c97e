#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <span>

#include "core/contact/contact_surface.h"
#include "core/contact/near_triangles.h"
#include "core/contact/plane_set.h"
#include "core/contact/sweep.h"
#include "core/contact/vertex_contact.h"

namespace haptrial::contact {

struct Arc;

/// Coulomb friction: while it sticks, the tangential force may be up to static_friction times the
/// normal force; once it slips, it is dynamic_friction times it.
struct Friction {
  double static_friction{0.0};   // mu_s >= mu_d
  double dynamic_friction{0.0};  // mu_d >= 0
};

enum class ContactState : std::uint8_t { kFree, kStick, kSlip };  // without friction: free or slip

/// End of the proxy on a tick, and the planes that hold it there.
struct ProxyState {
  Eigen::Vector3d position{Eigen::Vector3d::Zero()};  // of the proxy, object frame [m]
  /// Vector from the tool along the surfaces' normals: the push of the surfaces over the stiffness.
  Eigen::Vector3d pushed{Eigen::Vector3d::Zero()};  // [m]
  /// Vector from there to the proxy: the pull of friction over the stiffness.
  Eigen::Vector3d dragged{Eigen::Vector3d::Zero()};  // [m]
  /// The sum of what each surface pushes with: what friction is measured by. The length of `pushed`
  /// where one surface pushes, more in a groove.
  double pressure{0.0};  // [m]
  ContactState state{ContactState::kFree};
  int planes{0};                             // that push, 0 to 3
  std::array<std::int32_t, 3> triangles{};   // of these planes
  std::array<double, 3> push{};              // of each, along its normal [m]
  std::array<Eigen::Vector3d, 3> normals{};  // of each
  bool settled{true};  // false: the tick's work was used up, the way goes on on the next tick
};

struct ProxyOptions {
  double radius{0.0};  // >= 0; 0: a point [m]
  Friction friction{};
  int most_steps{16};  // a tick, 1 to 48
  int most_work{190};  // a tick, >= 1: after it and four steps no other follows (work_of)
  /// Ruspini's method is without the two: ways out of places where the planes stop the proxy and
  /// the triangles do not; paths round the arcs of a sphere.
  bool ways_out{true};
  bool arcs{true};
};

/// Cost of operations, in exact tests of a triangle against a point: counted, not timed, so that a
/// path gives the same proxy on every machine.
/// @param radius  of the proxy [m]
std::uint64_t work_of(const Operations& operations, double radius) noexcept;

/// The god object of a mesh: a point, or a sphere, that follows the tool as near as the surface
/// lets it and never passes through a triangle.
///
/// Every motion is a straight sweep against all triangles; it stops at the first. The planes that
/// stop it lead on: the next goal is the point nearest to the tool that all of them allow, and once
/// it is reached they are forgotten and found anew. Each step brings the proxy nearer to the tool.
/// Sources: Zilles and Salisbury 1995; Ruspini et al. 1997; Harwin and Melder 2002 (friction);
/// Morris 2006, §7.4.2 (friction); docs/algorithms/contact.md.
class Proxy {
 public:
  /// @throws std::invalid_argument naming the option that breaks its bound.
  Proxy(const ContactSurface& surface, const ProxyOptions& options);

  // Servo thread, all of the following: no allocation, lock, I/O or throw.

  /// Puts the proxy to a point, free. The point is beside the surface, or, for a sphere, nearer
  /// than the radius; then it is pushed out.
  void start(const Eigen::Vector3d& at) noexcept;
  /// One tick. @param tool  position in the object's frame [m]; not finite: nothing changes.
  const ProxyState& follow(const Eigen::Vector3d& tool) noexcept;
  const ProxyState& state() const noexcept { return state_; }
  /// Counts since start().
  const Operations& operations() const noexcept { return near_.operations(); }

  /// The corners of the last tick's way, from where the tick before ended; between them it was
  /// straight [m].
  std::span<const Eigen::Vector3d> way() const noexcept {
    return std::span(way_).first(static_cast<std::size_t>(way_length_));
  }
  const ContactSurface& surface() const noexcept { return *surface_; }
  const ProxyOptions& options() const noexcept { return options_; }

 private:
  struct Tick;
  PlaneSolution solve(const Tick& tick, const Eigen::Vector3d& wish) noexcept;
  bool advance(Tick& tick) noexcept;
  void break_off(Tick& tick) noexcept;
  bool go(Tick& tick, const Eigen::Vector3d& move) noexcept;
  bool still_held(Tick& tick) noexcept;
  void lift(Tick& tick) noexcept;
  bool blocked_at_once(const Sweep& sweep, double length, double enough) noexcept;
  bool leave_on(const Tick& tick, std::span<const int> which) noexcept;
  bool find_way_out(const Tick& tick) noexcept;
  void forget_planes() noexcept;
  bool come_to_rest(Tick& tick, const PlaneSolution& solution, bool sticks) noexcept;
  bool take_tangents(const Tick& tick, const Arc& arc, Eigen::Vector3d& to) noexcept;
  bool go_round(Tick& tick, const PlaneSolution& solution) noexcept;
  Eigen::Vector3d allowed_by_friction(const PlaneSolution& solution, bool& sticks) const noexcept;
  Eigen::Vector3d until_face_ends(Tick& tick, const PlaneSolution& solution,
                                  const Eigen::Vector3d& move) const noexcept;
  void rest(Tick& tick, const PlaneSolution& solution) noexcept;
  void step_to(const Eigen::Vector3d& at) noexcept;
  void step_back(const Eigen::Vector3d& to) noexcept;

  const ContactSurface* surface_;
  ProxyOptions options_;
  NearTriangles near_;
  PlaneSet planes_;
  PlaneSet before_;  // what was met before the planes were forgotten
  VertexContact corner_;
  ProxyState state_;
  bool slipping_{false};
  std::array<Eigen::Vector3d, 2 * 48 + 3> way_;
  int way_length_{0};
};

}  // namespace haptrial::contact
