#pragma once

#include <Eigen/Core>
#include <array>
#include <memory>
#include <span>
#include <vector>

#include "core/deformable/body/body_motion.h"
#include "core/deformable/touch/ball_contact.h"
#include "core/deformable/touch/body_touch.h"
#include "core/deformable/touch/energy_account.h"
#include "core/deformable/touch/moving_body.h"
#include "core/realtime/hand_over.h"

namespace haptrial::deformable {

/// Carries where a body's vertices are from the servo thread to one other thread, whole, for
/// pictures.
class MovingShape {
 public:
  explicit MovingShape(std::size_t vertices) {
    for (auto& slot : slots_) {
      slot.assign(vertices, Eigen::Vector3f::Zero());
    }
  }

  /// Servo thread: no allocation or lock.
  void write(const BodyMotion& motion) noexcept {
    std::vector<Eigen::Vector3f>& slot = slots_[turn_.writing()];
    for (std::size_t v = 0; v < slot.size(); ++v) {
      slot[v] = motion.position(v).cast<float>();
    }
    turn_.publish();
  }

  /// The other thread. @param places  (vertices) [m]; @returns false, leaving them alone, if
  /// nothing was written since.
  bool read(std::span<Eigen::Vector3d> places) noexcept {
    if (!turn_.take()) {
      return false;
    }
    const std::vector<Eigen::Vector3f>& slot = slots_[turn_.reading()];
    for (std::size_t v = 0; v < slot.size(); ++v) {
      places[v] = slot[v].cast<double>();
    }
    return true;
  }

 private:
  std::array<std::vector<Eigen::Vector3f>, realtime::HandOver::kSlots> slots_;
  realtime::HandOver turn_;
};

/// A body of springs or implicit elements that moves, with inertia, waves and large strains, and is
/// pressed by a ball, or held by the hand at its grasped vertices, which go with the hand from
/// start() on.
///
/// On each tick a body of springs makes several explicit steps, one of elements an implicit one,
/// while the hand goes on to the tool; what is felt is the mean force of these steps. An energy
/// account (energy_account.h) keeps it passive, and bound_change() takes care that a body whose
/// steps fail neither strikes the hand nor lets it fall. A tick is a function of the tool's places
/// alone, to the bit on every instruction set.
///
/// A point, and any ball below smallest_ball(), is felt as a ball of that radius. A ball that
/// begins in the surface grows there from what has room; one whose centre is inside touches nothing
/// until it has left. Source: Morris 2006, §5.4.1; docs/algorithms/deformable-moving.md.
class MovingTouch final : public BodyTouch {
 public:
  /// @param period  of a tick [s]  @param shape  null: no pictures
  /// @throws std::invalid_argument naming the option that breaks its bound; InputError as
  /// steps_on_a_tick().
  MovingTouch(SharedMovingBody body, const TouchOptions& options, double period,
              std::shared_ptr<MovingShape> shape = nullptr);

  void start(const Eigen::Vector3d& tool) noexcept override;
  /// Goes on from `before`, if it is of the same body; else starts, as start() does.
  void adopt(const BodyTouch& before, const Eigen::Vector3d& tool) noexcept override;
  /// @param period  is that of the constructor
  const contact::Contact& tick(const Eigen::Vector3d& tool, double period) noexcept override;
  std::span<const VertexForce> forces() const noexcept override {
    return std::span(forces_).first(force_count_);
  }
  const TouchCounts& counts() const noexcept override { return counts_; }

  const BodyMotion& motion() const noexcept { return *motion_; }
  const BallContact& ball() const noexcept { return ball_; }
  int steps() const noexcept { return steps_; }  // on a tick
  /// The last force without a tetrahedron inside out [N].
  double upright_force() const noexcept { return upright_; }
  /// Energy that the hand gave in this contact and did not get back [J].
  double balance() const noexcept { return account_.balance(); }

 private:
  void put_to_rest() noexcept;
  void advance(const Eigen::Vector3d& tool) noexcept;
  void pull(const Eigen::Vector3d& hand) noexcept;
  bool grasps() const noexcept { return !grip_.empty(); }
  void keep_forces() noexcept;
  void note_grip(const Eigen::Vector3d& tool) noexcept;
  void note(const Eigen::Vector3d& tool) noexcept;
  void limit() noexcept;
  void scale(double share) noexcept;
  bool together() const noexcept;

  SharedMovingBody body_;
  TouchOptions options_;
  double period_;
  int steps_;
  std::unique_ptr<BodyMotion> motion_;
  BallContact ball_;
  EnergyAccount account_;
  std::shared_ptr<MovingShape> shape_;
  std::vector<VertexForce> forces_;
  std::size_t force_count_{0};
  Eigen::Vector3d tool_{Eigen::Vector3d::Zero()};     // a tick ago [m]
  Eigen::Vector3d grip_at_{Eigen::Vector3d::Zero()};  // where the hand took hold [m]
  std::vector<Eigen::Vector3d> grip_;  // on each grasped vertex, mean over the steps [N]
  Eigen::Vector3d felt_{Eigen::Vector3d::Zero()};  // on the body, mean over the steps [N]
  std::uint64_t inverted_steps_{0};                // before this tick
  double upright_{0.0};                            // the last force without one inside out [N]
  std::uint64_t ticks_{0};
  contact::Contact contact_;
  TouchCounts counts_;
};

}  // namespace haptrial::deformable
