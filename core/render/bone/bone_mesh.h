#pragma once

#include <Eigen/Geometry>
#include <array>
#include <memory>
#include <vector>

#include "core/geometry/mesh/mesh.h"
#include "core/render/gl/gl.h"
#include "core/render/gl/gl_buffer.h"

namespace haptrial::render {

/// A corner of a mesh's triangle, with a normal of its own.
struct LitCorner {
  std::array<float, 3> place;
  std::array<float, 3> normal;
};

/// Three corners to a triangle. Normals are smooth over edges of less than 40 degrees.
std::vector<LitCorner> lit_corners(const geometry::Mesh& mesh);

/// Boxes that hold a mesh between them, cut across its longest side: less room than one where a
/// long tool lies aslant.
std::vector<Eigen::AlignedBox3d> slabs_of(const geometry::Mesh& mesh);

/// A mesh in OpenGL. One thread, with the context current.
class BoneMesh {
 public:
  BoneMesh(const Gl& gl, std::shared_ptr<const geometry::Mesh> mesh);
  ~BoneMesh();
  BoneMesh(const BoneMesh&) = delete;
  BoneMesh& operator=(const BoneMesh&) = delete;

  const geometry::Mesh* mesh() const noexcept { return mesh_.get(); }
  const std::vector<Eigen::AlignedBox3d>& slabs() const noexcept { return slabs_; }
  /// Draws the mesh; the constant value of attribute 2 is its colour.
  void draw() const;

 private:
  Gl gl_;
  std::shared_ptr<const geometry::Mesh> mesh_;
  std::vector<Eigen::AlignedBox3d> slabs_;
  GlBuffer corners_;
  int count_{0};
  Gl::Name array_{0};
};

}  // namespace haptrial::render
