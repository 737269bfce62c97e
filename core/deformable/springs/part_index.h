#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include "core/deformable/body/mesh_parts.h"

namespace haptrial::deformable {

/// Numbers of a mesh's edges and faces by their vertices, in any order of them. The edge or face
/// must be there.
class PartIndex {
 public:
  explicit PartIndex(const MeshParts& parts) : edges_(parts.edges), faces_(parts.faces) {
    for (Face& face : faces_) {
      std::sort(face.begin(), face.end());
    }
  }
  std::int32_t edge(std::int32_t a, std::int32_t b) const {
    return number(edges_, Edge{std::min(a, b), std::max(a, b)});
  }
  std::int32_t face(Face face) const {
    std::sort(face.begin(), face.end());
    return number(faces_, face);
  }

 private:
  template <class Part>
  static std::int32_t number(const std::vector<Part>& parts, const Part& part) {
    return static_cast<std::int32_t>(std::lower_bound(parts.begin(), parts.end(), part) -
                                     parts.begin());
  }
  std::vector<Edge> edges_;
  std::vector<Face> faces_;  // vertices in ascending order
};

}  // namespace haptrial::deformable
