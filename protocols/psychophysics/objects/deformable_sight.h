#pragma once

#include <Eigen/Core>
#include <memory>
#include <vector>

#include "core/contact/felt_body.h"
#include "core/deformable/body/skin.h"
#include "protocols/psychophysics/objects/seen_bodies.h"

namespace haptrial::protocols {

/// The surface of a body as it gives way, for pictures: of a block its outer faces, of a body
/// from a file the file's mesh, which follows the elements as a skin. Lengths are the body's own
/// frame [m]. One thread.
class DeformableSight {
 public:
  /// @param skin  null: the outer faces of the elements
  DeformableSight(SeenBody body, const contact::SharedBody& skin);

  /// Moves a body to its present shape: one that rests on every tick lies as these forces press it;
  /// beyond the vertices that a Compliance knows, those deeper than one element, nothing moves. A
  /// body that moves lies where it was published last.
  void update(std::span<const SeenForces::Force> forces);

  const std::vector<Eigen::Vector3d>& vertices() const { return skin_ ? fine_ : coarse_; }
  const std::vector<geometry::Triangle>& triangles() const { return triangles_; }
  /// Sides of the cells that can be touched, between vertices(); none if there is a skin.
  const std::vector<deformable::Edge>& grid() const { return grid_; }

 private:
  const deformable::HapticMesh& mesh() const;
  void press(std::span<const SeenForces::Force> forces);

  SeenBody body_;
  std::vector<std::int32_t> place_;      // by vertex of the HapticMesh; -1: none
  std::vector<Eigen::Vector3d> coarse_;  // (vertices of the HapticMesh)
  std::vector<Eigen::Vector3d> fine_;
  std::unique_ptr<deformable::Skin> skin_;
  std::vector<geometry::Triangle> triangles_;
  std::vector<deformable::Edge> grid_;
};

}  // namespace haptrial::protocols
