#pragma once

#include <Eigen/Core>
#include <memory>
#include <vector>

#include "core/contact/surface/felt_body.h"
#include "core/deformable/skin/skin.h"
#include "protocols/trials/objects/seen_bodies.h"

namespace haptrial::protocols {

/// The surface of a body as forces press it, for pictures: of a block its outer faces, of a body
/// from a file the file's mesh, which follows the elements as a skin. Lengths are the body's own
/// frame [m]. One thread.
class YieldingSight {
 public:
  /// @param skin  null: the outer faces of the elements
  YieldingSight(deformable::SharedCompliance body, const contact::SharedBody& skin);

  /// Beyond the vertices that a Compliance knows, those deeper than one element, nothing moves.
  void press(std::span<const SeenForces::Force> forces);

  const std::vector<Eigen::Vector3d>& vertices() const { return skin_ ? fine_ : coarse_; }
  const std::vector<geometry::Triangle>& triangles() const { return triangles_; }
  /// Sides of the cells that can be touched, between vertices(); none if there is a skin.
  const std::vector<deformable::Edge>& grid() const { return grid_; }

 private:
  deformable::SharedCompliance body_;
  std::vector<std::int32_t> place_;      // by vertex of the FeltMesh; -1: none
  std::vector<Eigen::Vector3d> coarse_;  // (vertices of the FeltMesh)
  std::vector<Eigen::Vector3d> fine_;
  std::unique_ptr<deformable::Skin> skin_;
  std::vector<geometry::Triangle> triangles_;
  std::vector<deformable::Edge> grid_;
};

}  // namespace haptrial::protocols
