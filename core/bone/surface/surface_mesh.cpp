#include "core/bone/surface/surface_mesh.h"

#include <vector>

namespace haptrial::bone {

geometry::Mesh mesh_of(const Surface& surface) {
  geometry::Mesh mesh;
  std::vector<std::int32_t> numbers(surface.vertices().size(), -1);
  for (const SurfaceTriangle& triangle : surface.triangles()) {
    if (triangle[0] == triangle[1] && triangle[1] == triangle[2]) {
      continue;  // of a quad that is gone
    }
    geometry::Triangle corners{};
    for (std::size_t c = 0; c < 3; ++c) {
      std::int32_t& number = numbers[triangle[c]];
      if (number < 0) {
        number = static_cast<std::int32_t>(mesh.vertices.size());
        const SurfaceVertex& vertex = surface.vertices()[triangle[c]];
        mesh.vertices.emplace_back(vertex.place[0], vertex.place[1], vertex.place[2]);
      }
      corners[c] = number;
    }
    mesh.triangles.push_back(corners);
  }
  return mesh;
}

geometry::Mesh surface_mesh(const BoneVolume& volume, const geometry::WorkReport& report) {
  Surface surface;
  surface.build(volume, report);
  return mesh_of(surface);
}

geometry::Mesh structure_mesh(const BoneModel& model, std::uint8_t label) {
  BoneModel part = model;
  for (std::size_t at = 0; at < part.labels.size(); ++at) {
    if (part.labels[at] == label) {
      continue;
    }
    part.labels[at] = 0;
    if (!part.density.empty()) {
      part.density[at] = 0.0F;
    }
  }
  return surface_mesh(BoneVolume(part));
}

}  // namespace haptrial::bone
