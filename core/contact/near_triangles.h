#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <string_view>
#include <vector>

#include "core/contact/contact_surface.h"
#include "core/contact/hull.h"
#include "core/contact/parted_triangles.h"
#include "core/contact/sweep.h"

namespace haptrial::contact {

/// Counted operations of a renderer since it was started: the same on every machine, other than its
/// time. Plain integers of the thread that renders.
struct Operations {
  std::uint64_t ticks{0};
  std::uint64_t sweeps{0};            // straight ways of a proxy, each against all triangles
  std::uint64_t triangles_tested{0};  // one at a time, exactly: a sweep's meeting, a plane's depth
  std::uint64_t triangles_passed{0};  // of a list, passed over by a bound
  std::uint64_t lists{0};             // of triangles around the proxy, gathered from the hierarchy
  std::uint64_t long_sweeps{0};       // through the whole hierarchy: beyond the list
  std::uint64_t nearest_searches{0};  // nearest points of the mesh, through the hierarchy
  std::uint64_t plane_solutions{0};   // points nearest to a goal on one, two or three planes
  std::uint64_t cells{0};             // of a grid, looked up

  friend bool operator==(const Operations&, const Operations&) = default;
};

/// All counts but the ticks, each with its name.
struct OperationCount {
  std::string_view name;
  std::uint64_t Operations::*count;
};
inline constexpr std::array kOperationCounts{
    OperationCount{"sweeps", &Operations::sweeps},
    OperationCount{"triangles tested", &Operations::triangles_tested},
    OperationCount{"triangles passed over", &Operations::triangles_passed},
    OperationCount{"lists gathered", &Operations::lists},
    OperationCount{"long sweeps", &Operations::long_sweeps},
    OperationCount{"nearest-point searches", &Operations::nearest_searches},
    OperationCount{"plane solutions", &Operations::plane_solutions},
    OperationCount{"cells", &Operations::cells},
};

/// The first triangle that a moving proxy meets. From tick to tick it remembers the triangles
/// around the proxy, each with a plane that kept the proxy apart from it, and a ball without any:
/// what cannot be met is not looked at, and the answers are the same.
class NearTriangles {
 public:
  /// @param radius  of the proxy; 0: a point [m]
  NearTriangles(const ContactSurface& surface, double radius);

  /// Forgets everything: the proxy is put elsewhere.
  void forget() noexcept;

  /// Whether the proxy meets a triangle on its move; then `hit` says where first.
  /// @param sweep  starts where the proxy is
  /// @param seen  receives the part of the move that was looked at: all of it for a point; for a
  ///     sphere less if the move is long
  bool first_hit(const Sweep& sweep, SweepHit& hit, double& seen) noexcept;

  /// Whether one triangle is met. Does not look at others.
  bool meets(const Sweep& sweep, std::int32_t slot, SweepHit& hit) noexcept;

  const Hull& hull(std::int32_t slot) noexcept { return hulls_.of(slot); }

  /// Counts since forget(). The proxy adds its own.
  Operations& operations() noexcept { return operations_; }
  const Operations& operations() const noexcept { return operations_; }

 private:
  bool meets(const Sweep& sweep, std::int32_t slot, double end, SweepHit& hit,
             Eigen::Vector3d& apart) noexcept;
  bool is_clear(const Sweep& sweep, double length) const noexcept;
  double listed_part(const Sweep& sweep, double length) const noexcept;
  bool list_around(const Sweep& sweep) noexcept;
  void adapt_reach(int count) noexcept;
  bool gather(const Sweep& sweep, double reach) noexcept;
  bool meets_listed(const Sweep& sweep, int i, double end, SweepHit& hit) noexcept;
  struct FirstMet;
  void test(const PartedTriangles::Candidate& candidate, FirstMet& first) noexcept;
  void test(std::span<PartedTriangles::Candidate> few, const PartedTriangles::Move& move,
            FirstMet& first) noexcept;
  bool first_listed(const Sweep& sweep, double end, double length, SweepHit& hit) noexcept;
  enum class ListOutcome { kMet, kFree, kEnds };  // ends: before the move does
  ListOutcome look_through_list(const Sweep& sweep, double length, double& part,
                                SweepHit& hit) noexcept;
  bool first_of_all(const Sweep& sweep, SweepHit& hit) noexcept;

  const ContactSurface* surface_;
  double radius_;
  Hulls hulls_;
  std::vector<NearTriangle> found_;  // as long as what is listed may be
  PartedTriangles listed_;
  std::vector<PartedTriangles::Candidate> candidates_;     // as long
  Eigen::Vector3d centre_{Eigen::Vector3d::Zero()};        // of the ball that the list covers [m]
  double covered_{-1.0};                                   // its radius; negative: no list [m]
  double reach_;                                           // of the next list [m]
  Eigen::Vector3d clear_centre_{Eigen::Vector3d::Zero()};  // of a ball without triangles [m]
  double clear_{-1.0};                                     // its radius [m]
  Operations operations_;
};

}  // namespace haptrial::contact
