#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "core/deformable/body/body_motion.h"
#include "core/deformable/touch/body_touch.h"
#include "core/deformable/touch/haptic_mesh.h"
#include "core/deformable/touch/normal_forces.h"
#include "core/deformable/touch/surface_samples.h"

namespace haptrial::deformable {

/// A ball that presses the surface of a moving body, step by step. After a free step no place p of
/// the surface (surface_samples.h) may be inside of the ball; forces over the last step see to it:
///
///     n · (p - y) >= r,  f >= 0,   y = x - Σ f / k
///
/// with the tool x, the ball's centre y and n from the ball into the body. How places give way on a
/// step is known from BodyMotion::mobility(): with masses at the vertices an explicit step has no
/// stiffness in it, an implicit one has a constant one. Friction
/// keeps the places, on the mean of their pressures, from moving along the ball, up to Coulomb's
/// bound. A ball whose centre is behind the surface does not touch it; one that is found in the
/// surface shrinks to what has room and grows slowly again.
/// After: Carpenter, Taylor and Katona 1991, Lagrange constraints for transient contact.
class BallContact {
 public:
  static constexpr std::size_t kMostPlaces = PressedPlaces::kMost;

  /// A point of the surface that the ball may press.
  struct Place {
    std::int32_t sample{};
    Eigen::Vector3d before{Eigen::Vector3d::Zero()};      // where it was before the step [m]
    Eigen::Vector3d after{Eigen::Vector3d::Zero()};       // and after it, as it was pressed [m]
    Eigen::Vector3d normal{Eigen::Vector3d::Zero()};      // n
    double pressed{0.0};                                  // f on the last step [N]
    Eigen::Vector3d sum{Eigen::Vector3d::Zero()};         // of the forces on it since gather() [N]
    Eigen::Vector3d sum_before{Eigen::Vector3d::Zero()};  // likewise, before the step
  };

  /// @param options  of a radius that the body's cells can show  @param period  of a tick [s]
  BallContact(const HapticMesh& mesh, const TouchOptions& options, double period);

  // Servo thread, all of the following: no allocation, lock or throw.

  /// No contact any more.
  void forget() noexcept;
  /// Goes on from `before`, if it was a ball of the same radius on the same body; any other contact
  /// is forgotten.
  void adopt(const BallContact& before) noexcept;
  /// Which places the ball may press on a tick, on which the tool goes from one point to another.
  void gather(const BodyMotion& motion, const Eigen::Vector3d& from,
              const Eigen::Vector3d& to) noexcept;
  /// Presses the body after a free step.
  void press(BodyMotion& motion, const Eigen::Vector3d& tool) noexcept;
  /// Presses after another round of that step, in place of the press before.
  void press_again(BodyMotion& motion, const Eigen::Vector3d& tool) noexcept;

  std::span<const Place> places() const noexcept { return std::span(places_).first(count_); }
  const SurfaceSamples::Sample& sample(const Place& place) const noexcept {
    return samples_.samples[static_cast<std::size_t>(place.sample)];
  }
  const SurfaceSamples& samples() const noexcept { return samples_; }
  /// Place of a sample in a body that moves, and in one at rest [m].
  Eigen::Vector3d where(const BodyMotion& motion, std::int32_t sample) const noexcept;
  Eigen::Vector3d at_rest(std::int32_t sample) const noexcept;
  double radius() const noexcept { return radius_; }                // now [m]
  const Eigen::Vector3d& force() const noexcept { return force_; }  // on the body, last step [N]
  const Eigen::Vector3d& friction() const noexcept { return friction_; }  // of it
  const Eigen::Vector3d& centre() const noexcept { return centre_; }      // y [m]
  bool slips() const noexcept { return slips_; }
  bool solved() const noexcept { return solved_; }    // since gather()
  bool crowded() const noexcept { return crowded_; }  // more places than fit: the nearest are taken
  /// How far a ball around `tool` is in the body as it would be at rest, at what it presses [m].
  double depth(const Eigen::Vector3d& tool) const noexcept;

 private:
  Eigen::Vector3d where(const BodyMotion& motion, const Place& place) const noexcept {
    return where(motion, place.sample);
  }
  void find_near(const BodyMotion& motion, const Eigen::Vector3d& middle, double reach) noexcept;
  void look_at(const BodyMotion& motion, std::int32_t sample, const Eigen::Vector3d& middle,
               double reach) noexcept;
  void add(const Place& place, double distance) noexcept;
  double room(const Eigen::Vector3d& centre) const noexcept;
  void rub_on(BodyMotion& motion) noexcept;
  void choose(const BodyMotion& motion, const Eigen::Vector3d& centre) noexcept;
  void find_compliance(const BodyMotion& motion) noexcept;
  void press_chosen(BodyMotion& motion) noexcept;
  void rub(BodyMotion& motion) noexcept;
  Place& chosen_place(Eigen::Index i) noexcept {
    return places_[chosen_[static_cast<std::size_t>(i)]];
  }
  double together(const BodyMotion& motion, const Place& a, const Place& b) const noexcept;
  void apply(BodyMotion& motion, Place& place, const Eigen::Vector3d& force) noexcept;

  const HapticMesh* mesh_;
  TouchOptions options_;
  SurfaceSamples samples_;
  double growth_;                         // on a tick [m]
  double radius_;                         // r, now [m]
  std::vector<std::int32_t> corners_;     // of the felt faces, each once
  std::vector<std::uint8_t> near_;        // by vertex
  std::vector<std::uint64_t> looked_at_;  // by sample: on which tick
  std::vector<double> kept_;              // by sample: the pressure of the tick before [N]
  std::uint64_t tick_{0};
  std::array<Place, kMostPlaces> places_;
  std::array<double, kMostPlaces> distance_{};
  std::size_t count_{0};
  std::array<std::size_t, kMostPlaces> chosen_{};  // places that may be pressed on the step
  PressedPlaces problem_;
  PressedPlaces::Matrix across_;  // of chosen places: compliance across n [m/N]
  PressedPlaces::Vector pressed_;
  Eigen::Vector3d centre_{Eigen::Vector3d::Zero()};
  Eigen::Vector3d centre_before_{Eigen::Vector3d::Zero()};  // the step
  Eigen::Vector3d force_{Eigen::Vector3d::Zero()};
  Eigen::Vector3d friction_{Eigen::Vector3d::Zero()};  // of it
  double pressure_{0.0};                               // sum of f [N]
  bool slips_{false};
  bool solved_{true};
  bool crowded_{false};
};

}  // namespace haptrial::deformable
