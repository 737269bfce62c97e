#pragma once

#include <Eigen/Core>
#include <array>
#include <span>

#include "core/deformable/touch/body_touch.h"
#include "core/deformable/touch/local_surface.h"
#include "core/deformable/touch/normal_forces.h"

namespace haptrial::deformable {

/// A ball on a surface that is known as it was a while ago, with how it gives way:
///
///     p = p_free + t v + C f n,   n · (p - y) >= r,  f >= 0,   y = x - Σ f / k
///
/// with the tool x, the ball's centre y, places p_free without normal forces, which drift with v,
/// and the age t of all that. Friction goes on from that of the body: the tool's way since then,
/// across the normal, bends it, up to Coulomb's bound.
class LocalContact {
 public:
  explicit LocalContact(const TouchOptions& options) : options_(options) {}

  // Servo thread: no allocation, lock or throw.

  void forget() noexcept;
  /// Another surface has come: it takes that as where the places are now.
  void look_at(const LocalSurface& surface) noexcept;
  /// @param surface  the one that was looked at last  @param age  [s]
  /// @returns whether anything is pressed
  bool tick(const LocalSurface& surface, const Eigen::Vector3d& tool, double age) noexcept;

  const Eigen::Vector3d& force() const noexcept { return force_; }  // on the body [N]
  const Eigen::Vector3d& centre() const noexcept { return centre_; }
  const Eigen::Vector3d& normal() const noexcept { return normal_; }  // into the body
  double depth() const noexcept { return depth_; }                    // of the ball at rest [m]
  bool slips() const noexcept { return slips_; }
  bool solved() const noexcept { return solved_; }
  /// Forces on vertices, some more than once. @returns how many
  std::size_t forces(const LocalSurface& surface, std::span<VertexForce> to) const noexcept;

 private:
  struct ChosenSample {
    std::size_t place{};
    Eigen::Vector3d normal{Eigen::Vector3d::Zero()};
  };

  void choose(const LocalSurface& surface, double age) noexcept;
  void press(const LocalSurface& surface, const Eigen::Vector3d& tool, double age) noexcept;
  void rub(const LocalSurface& surface, const Eigen::Vector3d& tool) noexcept;
  double across(const LocalSurface& surface) const noexcept;
  void respond(const LocalSurface& surface) noexcept;
  void find_depth(const LocalSurface& surface, const Eigen::Vector3d& tool) noexcept;
  const ChosenSample& chosen(Eigen::Index i) const noexcept {
    return chosen_[static_cast<std::size_t>(i)];
  }
  Eigen::Vector3d force_on(Eigen::Index i) const noexcept {
    return pressed_[i] * chosen(i).normal + pressed_[i] / pressure_ * friction_;
  }

  TouchOptions options_;
  std::array<Eigen::Vector3d, LocalSurface::kMost> moved_;  // by normal forces of the last tick [m]
  std::array<bool, LocalSurface::kMost> was_pressed_{};
  std::array<ChosenSample, LocalSurface::kMost> chosen_;
  PressedPlaces problem_;
  PressedPlaces::Vector pressed_;  // of the chosen [N]
  double pressure_{0.0};           // their sum
  Eigen::Vector3d friction_{Eigen::Vector3d::Zero()};
  Eigen::Vector3d bent_from_{Eigen::Vector3d::Zero()};  // the tool, where friction was `begun_`
  Eigen::Vector3d begun_{Eigen::Vector3d::Zero()};
  Eigen::Vector3d force_{Eigen::Vector3d::Zero()};
  Eigen::Vector3d centre_{Eigen::Vector3d::Zero()};
  Eigen::Vector3d normal_{Eigen::Vector3d::Zero()};
  double depth_{0.0};
  bool slips_{false};
  bool solved_{true};
};

}  // namespace haptrial::deformable
