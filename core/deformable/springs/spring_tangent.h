#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "core/deformable/body/block_matrix.h"
#include "core/deformable/body/load_case.h"
#include "core/deformable/springs/spring_body.h"

namespace haptrial::deformable {

/// The exact Hessian K of a body of springs without the held vertices, and directions that lower
/// the energy. K may be indefinite. A large body on a lattice is solved by conjugate gradients with
/// multigrid as long as they meet no negative curvature and converge soon, and by CHOLMOD
/// otherwise, with a raised diagonal where K is not positive definite.
class SpringTangent {
 public:
  /// @param body  must outlive this  @param held  by vertex
  SpringTangent(const SpringBody& body, std::vector<std::uint8_t> held);
  ~SpringTangent();

  /// Takes K at `positions`. @returns false where no raised diagonal makes K positive definite.
  bool set(std::span<const Eigen::Vector3d> positions);

  /// Sets the direction (K + raise)^-1 force, 0 on held vertices. After a set() that returned true.
  /// @param residual  the norm of what may be left of the force [N]; CHOLMOD's is at rounding
  /// @returns as set()
  bool solve(const Vectors& force, double residual, Vectors& direction);

  /// No negative curvature was met since set(), which is no proof.
  bool seems_definite() const;

  /// Whether K is positive definite: by its factors, or by conjugate gradients on a random force.
  /// With only positive curvature their residual's share along a direction of negative curvature
  /// never shrinks, so that convergence to a millionth shows that there is none.
  bool is_definite();

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// How far small forces move the vertices of a body that rests at `positions`: K^-1 f with the
/// exact Hessian K there; 0 for held vertices. One factorization.
/// @param forces  (vertices) [N]; those on held vertices do nothing
/// @returns displacements (vertices) [m]; nothing where K is not positive definite
std::optional<std::vector<Eigen::Vector3d>> small_displacements(
    const SpringBody& body, std::span<const Hold> holds, std::span<const Eigen::Vector3d> positions,
    std::span<const Eigen::Vector3d> forces);

/// The fastest vibration (body/fastest_vibration.h) of small motions about `positions` [1/s], with
/// the exact Hessian there (spring_hessian.h).
double fastest_vibration(const SpringBody& body, std::span<const Eigen::Vector3d> positions,
                         std::span<const std::int32_t> held = {});

/// The longest step of Verlet's method that is stable for small motions about the rest shape, 2 / ω
/// [s], with or without damping; infinite for a body without any stiffness. A body that is
/// stretched or crushed far may be stiffer: ask fastest_vibration() there.
double stable_step(const SpringBody& body, std::span<const std::int32_t> held = {});

}  // namespace haptrial::deformable
