#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "core/contact/proxy/operations.h"
#include "core/contact/proxy/sweep.h"
#include "core/contact/surface/contact_surface.h"

namespace haptrial::contact {

/// The first triangle that a moving proxy meets. From tick to tick it remembers the triangles
/// around the proxy, with a lower bound of how far each is away, and how far everything is: what
/// cannot be met is not looked at, and the answers are the same.
class NearTriangles {
 public:
  /// @param radius  of the proxy; 0: a point [m]
  NearTriangles(const ContactSurface& surface, double radius);

  /// Forgets everything: the proxy is put elsewhere.
  void forget() noexcept;
  /// The proxy has moved by this length [m].
  void moved(double length) noexcept { path_ += length; }

  /// Whether the proxy meets a triangle on its move; then `hit` says where first.
  /// @param sweep  starts where the proxy is
  /// @param seen  receives the part of the move that was looked at: all of it for a point; for a
  ///     sphere less if the move is long
  bool first_hit(const Sweep& sweep, SweepHit& hit, double& seen) noexcept;

  /// Whether one triangle is met. Does not look at others.
  bool meets(const Sweep& sweep, std::int32_t slot, SweepHit& hit) noexcept;

  /// Since forget(). The proxy adds its own.
  Operations& operations() noexcept { return operations_; }
  const Operations& operations() const noexcept { return operations_; }

 private:
  struct Known {
    std::int32_t slot;
    double ball;             // the triangle lies in a ball of this radius [m]
    Eigen::Vector3d centre;  // around this point [m]
    Eigen::Vector3d normal;  // and between two planes across this direction,
    double low, high;        // so high [m]
    // The same for a sphere: all of the triangle lies where axis · x <= level. An axis that
    // kept the sphere off once most often still does.
    Eigen::Vector3d axis;
    double level;  // [m]
  };

  bool is_clear(const Sweep& sweep, double length) noexcept;
  bool collect(const Sweep& sweep, double length) noexcept;
  bool list_around(const Sweep& sweep, double reach) noexcept;
  bool can_meet(const Sweep& sweep, int i, double end, double length) noexcept;
  bool meets_listed(const Sweep& sweep, int i, double end, SweepHit& hit) noexcept;
  bool first_listed(const Sweep& sweep, double end, double length, SweepHit& hit) noexcept;
  bool first_of_all(const Sweep& sweep, SweepHit& hit) noexcept;

  const ContactSurface* surface_;
  double radius_;
  std::vector<NearTriangle> found_;  // as long as what is listed may be
  std::vector<Known> listed_;
  std::vector<double> clear_until_;  // of each: the path at which the proxy may first touch it
                                     // [m]; infinite beyond the list
  int count_{0};
  Eigen::Vector3d centre_{Eigen::Vector3d::Zero()};        // of the ball that the list covers [m]
  double covered_{-1.0};                                   // its radius; negative: no list [m]
  double reach_;                                           // of the next list [m]
  Eigen::Vector3d clear_centre_{Eigen::Vector3d::Zero()};  // of a ball without triangles [m]
  double clear_{-1.0};                                     // its radius [m]
  double path_{0.0};                                       // of the proxy since the last list [m]
  Operations operations_;
};

}  // namespace haptrial::contact
