#include "core/deformable/elements/element_forces.h"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>

namespace haptrial::deformable {

using Eigen::Matrix3d;
using Eigen::Vector3d;

namespace {

std::size_t to_place(std::int32_t i) { return static_cast<std::size_t>(i); }

}  // namespace

ElementForces::ElementForces(const ElasticBody& body) {
  const PatchLayout& layout = body.patches();
  const Elasticity& elasticity = body.elasticity();
  const auto& vertices = body.mesh().vertices;
  std::int32_t most = 0;
  for (std::size_t p = 0; p < layout.patches(); ++p) {
    const std::int32_t first = layout.first_tet[p], end = layout.first_tet[p + 1];
    const std::size_t some = to_place(layout.tets[to_place(first)]);
    const std::size_t material = elasticity.material_of.empty() ? 0 : elasticity.material_of[some];
    patches_.push_back({first, 0.0, moduli(elasticity.materials[material])});
    most = std::max(most, end - first);
    for (std::int32_t t = first; t < end; ++t) {
      const auto corners = body.mesh().tetrahedra[to_place(layout.tets[to_place(t)])];
      Matrix3d edges;
      for (int i = 0; i < 3; ++i) {
        edges.col(i) = vertices[to_place(corners[static_cast<std::size_t>(i) + 1])] -
                       vertices[to_place(corners[0])];
      }
      tets_.push_back({corners, edges.inverse(), std::abs(edges.determinant()) / 6.0});
      patches_.back().volume += tets_.back().volume;
    }
  }
  patches_.push_back({static_cast<std::int32_t>(tets_.size()), 0.0, {}});
  room_.resize(static_cast<std::size_t>(most));
}

std::size_t ElementForces::add(const PaddedPoints& positions, PaddedPoints& forces) noexcept {
  std::size_t inverted = 0;
  for (std::size_t p = 0; p + 1 < patches_.size(); ++p) {
    const Patch& patch = patches_[p];
    const std::size_t first = to_place(patch.first), end = to_place(patches_[p + 1].first);
    double volume = 0.0;
    for (std::size_t t = first; t < end; ++t) {
      const Tet& tet = tets_[t];
      Deformation& now = room_[t - first];
      const Vector3d origin = positions[to_place(tet.corners[0])];
      Matrix3d edges;
      for (int i = 0; i < 3; ++i) {
        edges.col(i) = positions[to_place(tet.corners[static_cast<std::size_t>(i) + 1])] - origin;
      }
      Matrix3d& f = now.gradient;
      f.noalias() = edges * tet.inverse;
      now.cofactor.col(0) = f.col(1).cross(f.col(2));
      now.cofactor.col(1) = f.col(2).cross(f.col(0));
      now.cofactor.col(2) = f.col(0).cross(f.col(1));
      now.change = f.col(0).dot(now.cofactor.col(0));
      inverted += now.change > 0.0 ? 0 : 1;
      volume += tet.volume * now.change;
    }
    const double pressure = patch.moduli.bulk * (volume / patch.volume - 1.0);
    for (std::size_t t = first; t < end; ++t) {
      const Tet& tet = tets_[t];
      const Deformation& now = room_[t - first];
      const double j = std::max(now.change, kLeastVolume), root = std::cbrt(j);
      const double form = patch.moduli.shear / (root * root);
      const double turn = pressure - form * now.gradient.squaredNorm() / (3.0 * j);
      const Matrix3d stress = form * now.gradient + turn * now.cofactor;
      const Matrix3d pull = (-tet.volume * stress) * tet.inverse.transpose();
      forces[to_place(tet.corners[0])] -= pull.rowwise().sum();
      for (int i = 0; i < 3; ++i) {
        forces[to_place(tet.corners[static_cast<std::size_t>(i) + 1])] += pull.col(i);
      }
    }
  }
  return inverted;
}

}  // namespace haptrial::deformable
