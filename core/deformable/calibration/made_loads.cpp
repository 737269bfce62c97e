#include "core/deformable/calibration/made_loads.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>

#include "core/base/longest_of.h"
#include "core/deformable/body/mesh_parts.h"

namespace haptrial::deformable {
namespace {

using Eigen::Vector3d;
using Eigen::VectorXd;

constexpr std::size_t kPatches = 12;
constexpr double kRadius = 0.08;  // of a patch, of the body's extent

double extent_of(const geometry::TetMesh& body) {
  Vector3d low = body.vertices.front(), high = low;
  for (const Vector3d& p : body.vertices) {
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
  return (high - low).norm();
}

/// Vertices of the surface that nothing holds, ascending.
std::vector<std::int32_t> free_surface(const geometry::TetMesh& body,
                                       const std::vector<Hold>& holds) {
  const auto held = held_flags(body.vertices.size(), holds);
  std::vector<std::int32_t> result;
  for (const auto& face : mesh_parts(body.tetrahedra).surface) {
    for (const std::int32_t v : face) {
      if (held[static_cast<std::size_t>(v)] == 0) {
        result.push_back(v);
      }
    }
  }
  std::ranges::sort(result);
  const auto repeated = std::ranges::unique(result);
  result.erase(repeated.begin(), repeated.end());
  return result;
}

/// Middles of patches: each as far as possible from those before it and from what is held.
std::vector<std::int32_t> spread_middles(const geometry::TetMesh& body,
                                         const std::vector<std::int32_t>& surface,
                                         const std::vector<Hold>& holds) {
  std::vector<double> apart(surface.size(), std::numeric_limits<double>::infinity());
  const auto place = [&](std::int32_t v) -> const Vector3d& {
    return body.vertices[static_cast<std::size_t>(v)];
  };
  const auto keep_away = [&](std::int32_t from) {
    for (std::size_t i = 0; i < surface.size(); ++i) {
      apart[i] = std::min(apart[i], (place(surface[i]) - place(from)).norm());
    }
  };
  for (const Hold& hold : holds) {
    keep_away(hold.vertex);
  }
  std::vector<std::int32_t> middles;
  while (middles.size() < std::min(kPatches, surface.size())) {
    const auto farthest = std::ranges::max_element(apart) - apart.begin();
    middles.push_back(surface[static_cast<std::size_t>(farthest)]);
    keep_away(middles.back());
  }
  return middles;
}

/// One newton along an axis, spread evenly over the patch around a vertex.
LoadCase push_on(const geometry::TetMesh& body, const std::vector<std::int32_t>& surface,
                 const std::vector<Hold>& holds, std::int32_t middle, int axis, double radius) {
  LoadCase load{"", holds, {}};
  for (const std::int32_t v : surface) {
    if ((body.vertices[static_cast<std::size_t>(v)] -
         body.vertices[static_cast<std::size_t>(middle)])
            .norm() <= radius) {
      load.forces.push_back({v, Vector3d::Unit(axis)});
    }
  }
  for (NodalForce& nodal : load.forces) {
    nodal.force /= static_cast<double>(load.forces.size());
  }
  return load;
}

VectorXd stacked(const std::vector<Vector3d>& vectors) {
  return Eigen::Map<const VectorXd>(vectors[0].data(),
                                    3 * static_cast<Eigen::Index>(vectors.size()));
}

/// The part of a field that lies beside the span of an orthonormal basis.
VectorXd beside(VectorXd field, const std::vector<VectorXd>& basis) {
  for (const VectorXd& direction : basis) {
    field -= direction.dot(field) * direction;
  }
  return field;
}

/// A push and its response, of length 1.
struct Candidate {
  LoadCase load;
  VectorXd response;
};

void scale(LoadCase& load, double by) {
  for (NodalForce& nodal : load.forces) {
    nodal.force *= by;
  }
}

std::vector<Candidate> candidates_of(const geometry::TetMesh& body, const std::vector<Hold>& holds,
                                     double farthest, const Response& response) {
  const double radius = kRadius * extent_of(body);
  const std::vector<std::int32_t> surface = free_surface(body, holds);
  std::vector<Candidate> result;
  for (const std::int32_t middle : spread_middles(body, surface, holds)) {
    for (int axis = 0; axis < 3; ++axis) {
      Candidate& candidate = result.emplace_back();
      candidate.load = push_on(body, surface, holds, middle, axis, radius);
      const std::vector<Vector3d> displacement = response(candidate.load);
      candidate.response = stacked(displacement).normalized();
      scale(candidate.load, farthest / longest_of(displacement));
    }
  }
  return result;
}

}  // namespace

std::vector<Hold> common_holds(std::span<const LoadCase> loads) {
  std::vector<Hold> common;
  for (const Hold& hold : loads[0].holds) {
    const bool everywhere = std::ranges::all_of(loads, [&](const LoadCase& load) {
      return std::ranges::any_of(load.holds,
                                 [&](const Hold& other) { return other.vertex == hold.vertex; });
    });
    if (everywhere) {
      common.push_back({hold.vertex, Vector3d::Zero()});
    }
  }
  return common;
}

std::vector<LoadCase> made_loads(const geometry::TetMesh& body, const std::vector<Hold>& holds,
                                 std::span<const std::vector<Vector3d>> given, std::size_t count,
                                 const Response& response) {
  std::vector<VectorXd> basis;
  double farthest = 0.0;  // the mean of the loads [m]
  const auto extend = [&](const VectorXd& field) {
    const VectorXd rest = beside(field, basis);
    if (rest.norm() > 0.0) {
      basis.push_back(rest.normalized());
    }
  };
  for (const auto& displacement : given) {
    farthest += longest_of(displacement) / static_cast<double>(given.size());
    extend(stacked(displacement));
  }
  std::vector<Candidate> candidates = candidates_of(body, holds, farthest, response);
  std::vector<LoadCase> made;
  while (made.size() < count && !candidates.empty()) {
    const auto next = std::ranges::max_element(
        candidates, {}, [&](const Candidate& c) { return beside(c.response, basis).norm(); });
    made.push_back(std::move(next->load));
    made.back().name = fmt::format("made {}", made.size());
    extend(next->response);
    candidates.erase(next);
  }
  return made;
}

}  // namespace haptrial::deformable
