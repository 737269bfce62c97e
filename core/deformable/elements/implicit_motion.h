#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "core/base/big_array.h"
#include "core/deformable/body/body_motion.h"
#include "core/deformable/body/mesh_factor.h"
#include "core/deformable/elements/element_forces.h"

namespace haptrial::deformable {

/// How a body of elements is stepped.
struct ImplicitOptions {
  double step{4e-3};                    // h > 0 [s]
  double decay{0.0};                    // a >= 0: a free motion dies down with exp(-a t) [1/s]
  std::vector<std::int32_t> held{};     // vertices that do not move by themselves
  std::vector<std::int32_t> pressed{};  // vertices that push() may be called for
};

/// The part that all motions of one body share: neo-Hookean elements, and the matrix that their
/// steps are solved with,
///
///     H = (1 + 2 a h) M / h² + L,    L_ij = Σ over tetrahedra of  w V ∇φ_i · ∇φ_j
///
/// one number for each pair of vertices, factorized once. w is the modulus of plane waves,
/// K + 4/3 µ, as long as H keeps above the stiffness of the elements at rest, else more.
/// After: Bouaziz et al. 2014, Projective dynamics; Liu, Bouaziz and Kavan 2017, who step
/// hyperelastic bodies with the same matrix.
class ImplicitBody {
 public:
  /// @param elastic  of the neo-Hookean law, volume by patches
  /// @throws InputError for a step or decay that is not allowed, or a vertex that is not there.
  ImplicitBody(const ElasticBody& elastic, const ImplicitOptions& options);

  const ImplicitOptions& options() const noexcept { return options_; }
  std::span<const Eigen::Vector3d> rest() const noexcept { return rest_; }
  std::span<const double> masses() const noexcept { return masses_; }
  const ElementForces& forces() const noexcept { return forces_; }
  const MeshFactor& factor() const noexcept { return *factor_; }
  /// The place of a vertex among the free ones; -1: held.
  std::int32_t free(std::size_t vertex) const noexcept { return free_[vertex]; }
  double inertia() const noexcept {  // (1 + 2 a h) / h² [1/s²]
    return (1.0 + 2.0 * options_.decay * options_.step) / (options_.step * options_.step);
  }
  /// H⁻¹ of each vertex with a pressed one (vertices) [m/N]; empty if it is not pressed.
  std::span<const float> response(std::size_t pressed) const noexcept {
    const std::int32_t at = column_[pressed];
    return at < 0 ? std::span<const float>()
                  : std::span(responses_)
                        .subspan(static_cast<std::size_t>(at) * rest_.size(), rest_.size());
  }

 private:
  void factorize(const ElasticBody& elastic);
  void respond();

  ImplicitOptions options_;
  std::vector<Eigen::Vector3d> rest_;
  std::vector<double> masses_;
  std::vector<std::int32_t> free_;    // by vertex
  std::vector<std::int32_t> column_;  // by vertex: of responses_; -1: none
  ElementForces forces_;
  std::unique_ptr<MeshFactor> factor_;
  double stiffening_{1.0};
  std::vector<float> responses_;  // (pressed x vertices)
};

/// A body of elements in time, by backward Euler steps of which two rounds of descent are made:
///
///     x⁰ = x + h v,    xᵏ⁺¹ = xᵏ + H⁻¹ ((1 + 2 a h) M / h² (x⁰ − xᵏ) + f(xᵏ) + load)
///
/// After each round contact pushes the body by the same H, as much as it has to (refine()). At rest
/// nothing is left of H: the body is where its elements balance. Momentum is kept however far a
/// round is from the end.
class ImplicitMotion final : public BodyMotion {
 public:
  explicit ImplicitMotion(std::shared_ptr<const ImplicitBody> body);

  // Servo thread, all of these: no allocation, lock or throw (ImplicitMotionTest).

  void step() noexcept override;
  bool refine() noexcept override;
  void push(std::size_t vertex, const Eigen::Vector3d& force) noexcept override;
  double mobility(std::size_t vertex, std::size_t pushed) const noexcept override {
    const std::span<const float> response = body_->response(pushed);
    return response.empty() ? 0.0 : static_cast<double>(response[vertex]);
  }
  bool spreads() const noexcept override { return true; }
  void finish_pushes() noexcept override;

 private:
  void descend() noexcept;
  void set_velocities() noexcept;

  std::shared_ptr<const ImplicitBody> body_;
  ElementForces elements_;
  double inertia_;                   // (1 + 2 a h) / h² [1/s²]
  PaddedPoints before_, predicted_;  // x of the step before; x⁰
  PaddedPoints pushes_;              // of this round [N]
  int round_{0};                     // of this step, from 1
  BigArray<MeshFactor::Row> room_;   // by place in the factor
};

}  // namespace haptrial::deformable
