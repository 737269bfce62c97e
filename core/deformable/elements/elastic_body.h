#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "core/deformable/body/block_matrix.h"
#include "core/deformable/elements/material.h"
#include "core/deformable/elements/volume_patches.h"
#include "core/geometry/volume/tetrahedralize.h"

namespace haptrial::deformable {

/// Material of a body and the formulation of its elements.
struct Elasticity {
  std::vector<Material> materials{{}};
  std::vector<std::uint8_t> material_of{};  // of each tetrahedron; empty: the first for all
  Law law{Law::kNeoHookean};
  VolumeForm volume{VolumeForm::kPatches};
};

/// The density of each tetrahedron's material [kg/m³].
std::vector<double> densities(const Elasticity& elasticity, std::size_t tetrahedra);

/// Stress state of one tetrahedron.
struct TetState {
  Eigen::Matrix3d gradient;  // F
  Eigen::Matrix3d stress;    // Cauchy [Pa]; of the linear law the stress of small strains
};

/// Linear tetrahedra: the energy of a displacement u of the vertices, minus its gradient (the
/// forces), and its second derivative (the stiffness), all exact for the law.
/// Source: Morris 2006, §5.3.2 ("an implicit finite element analysis").
class ElasticBody {
 public:
  /// @throws InputError as check_body() and check_material(), and for a material that is not there.
  ElasticBody(const geometry::TetMesh& mesh, Elasticity elasticity);
  ~ElasticBody();
  ElasticBody(ElasticBody&&) noexcept;

  const geometry::TetMesh& mesh() const;
  const Elasticity& elasticity() const;
  const PatchLayout& patches() const;
  std::span<const double> masses() const;  // by vertex: a quarter of its tetrahedra's [kg]

  /// Rounding error alone of forces that balance [N], as a norm over all vertices.
  double rounding_force() const;

  /// The first tetrahedron that `u` turns inside out or flat; -1: none.
  std::int32_t inverted(const Vectors& u) const;

  /// The elastic energy [J]: infinite where a tetrahedron is inverted, but for the linear law.
  double energy(const Vectors& u) const;

  /// Sets the elastic forces on the vertices [N]. @returns the energy; where that is infinite the
  /// forces have no meaning.
  double forces(const Vectors& u, Vectors& forces) const;

  /// Sets the stiffness [N/m], a matrix of this body's layout, and the forces; as forces().
  double stiffness(const Vectors& u, Vectors& forces, BlockMatrix& stiffness) const;

  /// Deformation and stress of each tetrahedron, the pressure being its patch's.
  std::vector<TetState> states(const Vectors& u) const;

  /// The strain of volume of each patch: the mean of theta (tet_laws.h).
  std::vector<double> volume_strains(const Vectors& u) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace haptrial::deformable
