#pragma once

#include <memory>

#include "core/contact/contact_surface.h"
#include "core/contact/signed_distance.h"
#include "core/geometry/mesh/mesh.h"
#include "core/geometry/volume/mesh_repair.h"

namespace haptrial::contact {

/// A mesh with all that is asked of it while it is felt or compared with a recording: prepared
/// once, shared by any number of renderers and threads.
struct FeltBody {
  /// @throws InputError as ContactSurface does
  explicit FeltBody(geometry::Mesh shape);
  FeltBody(const FeltBody&) = delete;
  FeltBody& operator=(const FeltBody&) = delete;

  geometry::Mesh mesh;
  ContactSurface surface;
  SignedDistance distance;
  double size{0.0};    // the diagonal of its box [m]
  bool closed{false};  // every side of a triangle has one other on it: there is an inside
  geometry::Facing facing{geometry::Facing::kOutwards};  // of a closed body; inwards: it is a room
};

using SharedBody = std::shared_ptr<const FeltBody>;

/// The body of a mesh; one of the last few if it is of the same mesh, as a definition is read many
/// times. Any thread. @throws InputError as ContactSurface does
SharedBody felt_body(geometry::Mesh mesh);

/// Place for a tool that is to be free at `p`: there, or, inside a closed body, just outside of it.
/// Servo thread. @param p  in the body's frame [m] @param radius  of the tool [m]
Eigen::Vector3d free_place(const FeltBody& body, const Eigen::Vector3d& p, double radius) noexcept;

}  // namespace haptrial::contact
