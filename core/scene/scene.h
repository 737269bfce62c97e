#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/base/point_state.h"
#include "core/control/gain_shares.h"
#include "core/scene/field.h"
#include "core/scene/low_pass.h"

namespace haptrial::scene {

/// Fields that act together: their forces are added on every tick of the servo loop. Which of them
/// act is a mask of bits, one a field in the order of the constructor; a stage sets it at its
/// beginning and the fields fade in and out.
///
///     Scene scene(fields, 1000.0);            // before the trial, any thread
///     scene.start_from(previous);             // servo thread: what goes on acting does not jump
///     scene.restart_with(0b101);              // servo thread, when an interval begins
///     scene.switch_to(0b100);                 // servo thread, when another stage begins
///     force = scene.force(hand);              // servo thread, every tick
///
/// Numbers that change between trials make a new scene. Reliefs are summed first, then surfaces,
/// then what lies on them or in free space, whatever the order of the fields.
class Scene {
 public:
  static constexpr std::size_t kMostFields = 64;
  static constexpr std::uint64_t kAll = ~std::uint64_t{0};

  /// @param rate  of the servo loop > 0 [Hz]
  /// @throws std::invalid_argument naming the field and the parameter that breaks its bound, for a
  ///         name that occurs twice, or for a field on something that is not a surface of the
  ///         scene.
  Scene(const std::vector<Field>& fields, double rate);
  ~Scene();
  Scene(Scene&&) noexcept;
  Scene& operator=(Scene&&) noexcept;

  // Servo thread, all of the following: no allocation, lock, I/O or throw.

  /// Fields in the mask fade in, the others fade out. A field that is on already goes on; one that
  /// is switched on begins anew (its time, filters and extremes) at the next tick, except that one
  /// without a course in time goes on if it still fades out.
  void switch_to(std::uint64_t mask) noexcept;
  /// All fields fade out, and those that do so already are through within `longest` [s].
  void switch_off(double longest) noexcept;
  /// The same, but fields with a course in time begin anew, even if they are on already: an
  /// interval begins, or is repeated.
  void restart_with(std::uint64_t mask) noexcept;
  /// Takes over weights, times, filters and bristles of fields that are of the same kind at the
  /// same index in `before`. What the next mask does not have fades out with the numbers of
  /// `before`, from which its law is borrowed. @param before  outlives the scene's use
  void start_from(Scene& before) noexcept;
  /// One tick later. @param hand  position [m] and velocity [m/s] in W
  /// @param shares  of the fields' gains that the handle carries now
  /// @param channels  values that laws may follow (DeviceReading::channels)
  /// @returns the force on the hand [N]; zero, with nothing changed, if the hand is not finite.
  Eigen::Vector3d force(const PointState& hand, const control::GainShares& shares = {},
                        std::span<const double> channels = {}) noexcept;
  /// Stimulus of the tick before the last that ended with the last, since its field was switched
  /// off without a fade or began anew [N].
  const Eigen::Vector3d& ended() const noexcept { return ended_; }
  /// Begins max_depth, max_force and work of every field anew: at a stage's beginning.
  void forget_extremes() noexcept;

  std::size_t size() const noexcept;
  std::uint64_t mask() const noexcept;  // what is switched on
  /// State of a field after the last tick. @param field  below size()
  const FieldState& state(std::size_t field) const noexcept;
  /// How a body that gives way is touched; null for any other field. @param field  below size()
  const deformable::BodyTouch* touch(std::size_t field) const noexcept;

  /// Energy that the conservative fields that act store if the hand is at p, with their weights of
  /// the last tick [J]. Not for a scene with a field whose force is not minus a gradient.
  double energy(const Eigen::Vector3d& p) noexcept;

 private:
  struct Part;
  void feel(Part& part, const Felt& felt) noexcept;
  void store(Part& part, double share) noexcept;
  /// @param ahead  of the hand (OwnWay) [m]
  void lay_reliefs(const Eigen::Vector3d& p, const Eigen::Vector3d& ahead) noexcept;
  void end_stimuli_of_reliefs() noexcept;

  std::vector<Part> parts_;
  std::vector<std::size_t> reliefs_;
  std::vector<std::size_t> surfaces_;
  std::vector<std::size_t> forces_;  // surfaces, then what may lie on them: all but reliefs
  double period_;
  OwnWay way_;
  Eigen::Vector3d before_{Eigen::Vector3d::Zero()};  // the hand a tick ago [m]
  double share_{1.0};                                // of stiffness, a tick ago
  Eigen::Vector3d ended_{Eigen::Vector3d::Zero()};   // [N]
};

}  // namespace haptrial::scene
