#pragma once

#include <Eigen/Geometry>
#include <array>
#include <atomic>
#include <memory>
#include <span>

#include "core/base/tool_state.h"
#include "core/bone/model/world.h"
#include "core/bone/simulator/plate.h"
#include "core/bone/simulator/simulator_tools.h"

namespace haptrial::bone {

inline constexpr int kMaxScrews = 64;

/// The place of a screw, which never changes.
struct ScrewPlace {
  int plate{-1};  // of the world
  int hole{0};    // of the plate, from 0
  int tool{0};    // that drove it first
};

/// A screw in a hole of a plate.
struct Screw {
  ScrewPlace place;
  int piece{-1};         // that its thread met last; -1: none
  double depth{0.0};     // of its tip below the plate; 0: its plate came off [m]
  double purchase{0.0};  // length of solid bone that its thread is in: density times length [m]
  double torque{0.0};    // that the last turn took [N·m]
};

/// The screws of a session. A screw driver that is held at a free hole of a plate that is fixed,
/// along the hole's axis, and is given power turns a screw into it:
///
///     s' = pitch · turns · power,   purchase = ∫ ρ ds,   torque = rate · purchase
///
/// with the mean density ρ of bone on the circle of the thread, up to the screw's length or until
/// the hand goes. No pilot hole is needed, no bone goes, and nothing strips; the torque is recorded
/// and not felt, as devices with a point force have none. Purchase is what holds: in a slot or in
/// air a screw has none. The source names screws and does not simulate them: Morris 2006, §3.1.2.
///
/// Servo thread after construction: no allocation, lock, wait or throw; count() and place() any
/// thread.
class Screws {
 public:
  /// Before everything else on a tick.
  void begin_tick() noexcept { ended_ = -1; }
  /// One tick of a driver. @param models  of plates, by tool  @param number  of the driver's tool
  void drive(const BoneWorld& world, std::span<const std::unique_ptr<PlateModel>> models,
             const ScrewTool& tool, int number, const ToolState& state, double power,
             double dt) noexcept;
  /// The hand has let go of the driver, or taken another tool.
  void rest() noexcept;
  /// A plate comes off: its screws are in no bone any more.
  void take_out(int plate) noexcept;
  /// The screw whose driving ended on this tick; null: none did.
  const Screw* ended() const noexcept { return ended_ >= 0 ? &screws_[at(ended_)] : nullptr; }

  int count() const noexcept { return count_.load(std::memory_order_acquire); }
  /// Any thread.
  ScrewPlace place(int number) const noexcept { return screws_[at(number)].place; }
  const Screw& screw(int number) const noexcept { return screws_[at(number)]; }

 private:
  struct Hole {
    int plate{-1};  // none is near
    int hole{0};
    Eigen::Isometry3d pose{Eigen::Isometry3d::Identity()};  // X_W, on the bone side, z outwards
  };
  static std::size_t at(int number) noexcept { return static_cast<std::size_t>(number); }
  Hole hole_at(const BoneWorld& world, std::span<const std::unique_ptr<PlateModel>> models,
               const ToolState& state) const noexcept;
  int screw_in(const Hole& hole, int tool) noexcept;

  std::array<Screw, kMaxScrews> screws_;
  std::atomic<int> count_{0};
  int driven_{-1};
  int ended_{-1};
};

}  // namespace haptrial::bone
