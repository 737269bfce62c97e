#pragma once

#include <string>
#include <vector>

#include "core/geometry/mesh/mesh.h"

namespace haptrial::contact {

/// A mesh that is hard on a proxy, and whether nothing may ever get into it.
struct HardMesh {
  std::string name;
  geometry::Mesh mesh;
  bool closed{true};
};

/// A box between two corners, two triangles to a side.
geometry::Mesh make_box(const Eigen::Vector3d& low, const Eigen::Vector3d& high);

/// Two meshes as one.
geometry::Mesh joined(const geometry::Mesh& a, const geometry::Mesh& b);

/// Splits edges of a closed mesh close to one of their ends: by 10^-3 to 10^-16 of their length.
/// It stays closed, to the rounding of the new corners.
geometry::Mesh with_slivers(geometry::Mesh mesh, int count, std::uint64_t seed);

/// Turns every triangle round with a chance of one half.
geometry::Mesh with_inverted_faces(geometry::Mesh mesh, std::uint64_t seed);

/// Gives one triangle a corner of its own, moved by `gap`: a crack.
geometry::Mesh with_crack(geometry::Mesh mesh, double gap);

/// Slivers, thin plates, cracks of one vertex, inverted faces, wedges, needles, meshes that are not
/// manifold: all about 1 in size.
std::vector<HardMesh> hard_meshes();

/// Closed meshes of data from outside that are there; empty if none is.
std::vector<HardMesh> scanned_meshes();

}  // namespace haptrial::contact
