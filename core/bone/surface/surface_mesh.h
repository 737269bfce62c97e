#pragma once

#include "core/bone/surface/surface.h"
#include "core/geometry/mesh/mesh.h"

namespace haptrial::bone {

/// The living triangles of a surface as a mesh in B [m], with the vertices that they use.
geometry::Mesh mesh_of(const Surface& surface);

/// The surface of what a volume holds. Empty where it holds nothing.
geometry::Mesh surface_mesh(const BoneVolume& volume, const geometry::WorkReport& report = {});

/// The surface of what a bone has of one label. Empty where it has nothing.
geometry::Mesh structure_mesh(const BoneModel& model, std::uint8_t label);

}  // namespace haptrial::bone
