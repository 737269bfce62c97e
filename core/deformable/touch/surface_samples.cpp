#include "core/deformable/touch/surface_samples.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <map>

namespace haptrial::deformable {
namespace {

/// A sample by its corners in ascending order and its steps towards each; corners without steps
/// are left out, so that every face names a point of an edge alike.
using Name = std::array<std::pair<std::int32_t, int>, 3>;

Name name_of(const Face& face, const std::array<int, 3>& steps) {
  Name name;
  for (std::size_t k = 0; k < 3; ++k) {
    name[k] = steps[k] > 0 ? std::pair{face[k], steps[k]} : std::pair{-1, 0};
  }
  std::ranges::sort(name);
  return name;
}

/// A corner without weight stands for one that has some: the other faces of an edge lack it.
Face corners_of(const Face& face, const std::array<int, 3>& steps) {
  const auto most = static_cast<std::size_t>(std::ranges::max_element(steps) - steps.begin());
  Face corners = face;
  for (std::size_t k = 0; k < 3; ++k) {
    corners[k] = steps[k] > 0 ? face[k] : face[most];
  }
  return corners;
}

}  // namespace

SurfaceSamples::SurfaceSamples(std::span<const Face> faces, std::span<const Eigen::Vector3d> rest,
                               int steps) {
  const auto at_rest = [&](std::int32_t corner) -> const Eigen::Vector3d& {
    return rest[static_cast<std::size_t>(corner)];
  };
  std::map<Name, std::int32_t> known;
  for (const Face& face : faces) {
    const Eigen::Vector3d a = at_rest(face[0]);
    const Eigen::Vector3d outward =
        (at_rest(face[1]) - a).cross(at_rest(face[2]) - a).stableNormalized();
    for (int i = 0; i <= steps; ++i) {
      for (int j = 0; i + j <= steps; ++j) {
        const std::array<int, 3> counts{i, j, steps - i - j};
        const auto [at, is_new] =
            known.try_emplace(name_of(face, counts), static_cast<std::int32_t>(samples.size()));
        if (is_new) {
          samples.push_back({corners_of(face, counts),
                             Eigen::Vector3d(counts[0], counts[1], counts[2]) / steps,
                             {0.0, 0.0, 0.0}});
        }
        samples[static_cast<std::size_t>(at->second)].outward += outward;
        of_face.push_back(at->second);
      }
    }
  }
  for (Sample& sample : samples) {
    sample.outward.stableNormalize();
    for (std::size_t k = 0; k < 3; ++k) {
      sample.rest += sample.weight[static_cast<Eigen::Index>(k)] *
                     rest[static_cast<std::size_t>(sample.corners[k])];
    }
  }
  per_face = faces.empty() ? 0 : of_face.size() / faces.size();
}

}  // namespace haptrial::deformable
