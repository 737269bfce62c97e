#include "analysis/bone_drilling/feedback/scene_mesh.h"

#include <meshoptimizer.h>

#include <algorithm>
#include <cmath>

#include "core/bone/surface/surface.h"

namespace haptrial::analysis::drilling {
namespace {

constexpr std::size_t kMostVertices = 65536;

std::vector<std::uint32_t> living(const bone::Surface& surface) {
  std::vector<std::uint32_t> corners;
  for (const bone::SurfaceTriangle& triangle : surface.triangles()) {
    if (triangle[0] != triangle[1] || triangle[1] != triangle[2]) {
      corners.insert(corners.end(), triangle.begin(), triangle.end());
    }
  }
  return corners;
}

std::size_t vertices_in(const std::vector<std::uint32_t>& corners, std::size_t vertices) {
  std::vector<bool> used(vertices, false);
  for (const std::uint32_t corner : corners) {
    used[corner] = true;
  }
  return static_cast<std::size_t>(std::count(used.begin(), used.end(), true));
}

/// Fewer triangles, as many as asked for where the surface's holes and handles let it be.
void simplify(const bone::Surface& surface, std::size_t most, std::vector<std::uint32_t>& corners) {
  constexpr float kAnyError = 1.0F;  // of the whole extent: the number of triangles decides
  const auto& vertices = surface.vertices();
  const auto reduce = [&](std::size_t triangles, bool sloppily) {
    std::vector<std::uint32_t> fewer(corners.size());
    const auto* places = vertices.front().place.data();
    const std::size_t left =
        sloppily ? meshopt_simplifySloppy(fewer.data(), corners.data(), corners.size(), places,
                                          vertices.size(), sizeof(bone::SurfaceVertex),
                                          3 * triangles, kAnyError, nullptr)
                 : meshopt_simplify(fewer.data(), corners.data(), corners.size(), places,
                                    vertices.size(), sizeof(bone::SurfaceVertex), 3 * triangles,
                                    kAnyError, 0, nullptr);
    fewer.resize(left);
    corners = std::move(fewer);
  };
  if (corners.size() > 3 * most) {
    reduce(most, false);
  }
  // Crumbs and pores cannot lose any more triangles without changing how they hang together.
  for (std::size_t triangles = most;
       triangles > 0 && vertices_in(corners, vertices.size()) > kMostVertices; triangles /= 2) {
    reduce(triangles, true);
  }
}

}  // namespace

SceneMesh scene_surface(const bone::BoneModel& bone, std::size_t most) {
  bone::Surface surface;
  surface.build(bone::BoneVolume(bone));
  std::vector<std::uint32_t> corners = living(surface);
  if (corners.empty()) {
    return {};
  }
  simplify(surface, most, corners);
  SceneMesh mesh;
  constexpr std::int32_t kNone = -1;
  std::vector<std::int32_t> numbers(surface.vertices().size(), kNone);
  for (std::size_t at = 0; at < corners.size(); at += 3) {
    std::array<std::uint16_t, 3> triangle{};
    for (std::size_t c = 0; c < 3; ++c) {
      std::int32_t& number = numbers[corners[at + c]];
      if (number == kNone) {
        number = static_cast<std::int32_t>(mesh.places.size());
        const bone::SurfaceVertex& vertex = surface.vertices()[corners[at + c]];
        mesh.places.push_back(vertex.place);
        mesh.labels.push_back(vertex.label);
      }
      triangle[c] = static_cast<std::uint16_t>(number);
    }
    mesh.triangles.push_back(triangle);
  }
  return mesh;
}

SceneMesh scene_structure(const bone::BoneModel& bone, const std::vector<bool>& wanted,
                          std::size_t most) {
  bone::BoneModel part = bone;
  part.density.clear();
  bool any = false;
  for (std::uint8_t& label : part.labels) {
    const bool stays = label < wanted.size() && wanted[label];
    label = stays ? label : std::uint8_t{0};
    any = any || label != 0;
  }
  if (!any) {  // all of it was drilled away
    return {};
  }
  crop_to_bone(part);
  return scene_surface(part, most);
}

SceneGrid SceneGrid::around(const Eigen::AlignedBox3d& box) {
  constexpr double kSteps = 65535.0;
  return {box.min(), std::max(box.sizes().maxCoeff(), 1e-9) / kSteps};
}

void SceneGrid::add(const Eigen::Vector3d& place, std::string& bytes) const {
  for (int axis = 0; axis < 3; ++axis) {
    const auto number = static_cast<std::uint16_t>(
        std::clamp(std::round((place[axis] - low[axis]) / step), 0.0, 65535.0));
    bytes += static_cast<char>(number & 0xFFU);
    bytes += static_cast<char>(number >> 8U);
  }
}

}  // namespace haptrial::analysis::drilling
