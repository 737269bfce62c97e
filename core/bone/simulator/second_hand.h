#pragma once

#include <Eigen/Core>
#include <memory>

#include "core/base/tool_state.h"
#include "core/bone/drill/feel.h"
#include "core/bone/dust/dust_surroundings.h"
#include "core/bone/model/world.h"
#include "core/bone/simulator/felt_part.h"
#include "core/bone/simulator/soft_tissue.h"
#include "core/bone/simulator/tool_contact.h"

namespace haptrial::bone {

/// A tube that sucks and rinses, held in the other hand. Its end is felt as a ball as wide as its
/// wall, and so is as much of the tube behind it as is told.
struct TubeParameters {
  double radius{1.2e-3};            // of its opening, 0.2e-3 to 0.01 [m]
  double handle_length{0.1};        // > 0 [m]
  double rinse_reach{6e-3};         // of its water from its end > 0 [m]
  double shaft_length{0.0};         // behind its end that is felt, too, >= 0 [m]
  FeelParameters feel{};            // default_feel() of its outer radius
  ToolContactParameters at_tool{};  // with the tool in the first hand
  double outer_radius() const noexcept { return 1.4 * radius; }  // [m]
};

/// Input of the other hand on one tick, in W.
struct TubeInput {
  ToolState tool;
  bool sucks{false};
  bool rinses{false};
};

struct TubeOutput {
  Eigen::Vector3d force{Eigen::Vector3d::Zero()};  // of bone and soft tissue on its end [N]
  Eigen::Vector3d shaft{Eigen::Vector3d::Zero()};  // of bone on the tube behind it [N]
  bool contact{false};                             // with bone
  bool yields{false};                              // soft tissue gives way to it
  int immersed{0};                                 // samples of its end in bone
  bool tore{false};
};

/// The tube at the bones that the first hand works on: it feels them and takes none of them; soft
/// tissue gives way to it, sticks to it where it sucks, and may tear. The first hand's tool pushes
/// it if it is told to (ToolContact). One that is in bone at first is not felt before it has been
/// free.
///
/// Servo thread: no allocation, lock, wait or throw after construction. Source: Morris 2006,
/// §3.2.8, Figure 66.
class SecondHand {
 public:
  /// @throws std::invalid_argument naming the parameter that breaks its bound.
  SecondHand(const TubeParameters& parameters, std::span<const Structure> structures,
             double spacing, const std::array<bool, 256>& soft);

  void begin() noexcept;
  /// Call after the first hand's tick.
  TubeOutput tick(const BoneWorld& world, SoftTissue& soft, const TubeInput& input,
                  const ForceTransition& transition = {}) noexcept;
  /// Bone feels otherwise to the tube's end from now on (FeltPart::feel_as()).
  void feel_as(const FeelParameters& feel) noexcept { end_.feel_as(feel); }
  /// Force of the tube on the first hand's tool; the opposite acts on the tube. Zero where the two
  /// pass through each other.
  /// @param tool  its rods  @param velocity  of its tip [m/s]  @param dt  of the tick [s]
  Eigen::Vector3d push(std::span<const Rod> tool, const Eigen::Vector3d& velocity,
                       const TubeInput& input, double dt) noexcept;
  /// The first hand has another tool, or none at work.
  void leave_tool() noexcept { at_tool_.wait(); }
  /// Fills in the tube that sucks dust and the water that rinses blood away.
  void place(const TubeInput& input, DustTool& tube, DustWater& water) const noexcept;
  /// Whether its water gets to a point of W.
  bool rinses(const TubeInput& input, const Eigen::Vector3d& p_W) const noexcept;

  const TubeParameters& parameters() const noexcept { return p_; }

 private:
  TubeParameters p_;
  FeltPart end_;
  std::unique_ptr<FeltPart> shaft_;  // null: it is not felt
  ToolContact at_tool_;
};

}  // namespace haptrial::bone
