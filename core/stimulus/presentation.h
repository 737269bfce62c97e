#pragma once

#include <Eigen/Core>
#include <cstdint>

#include "core/stimulus/shown.h"

namespace haptrial::stimulus {

/// Instruction to the participant in this pass.
enum class Instruction : std::uint8_t {
  kRest,       // no task
  kHoldPlane,  // keep the device in the plane against its force (haptic training)
  kWatch,      // watch the target bar (visual training)
  kMatch,      // make the applied bar as high as the target bar (visuohaptic training)
  kRecall,     // apply the learnt pattern (test)
  kFollow,     // let the hand be led, and press as the force asks (haptic playback)
  kReproduce,  // move along the learnt path and apply the learnt pattern (free test)
};

/// Picture of a participant who follows a path, at one instant: a view (shown.h). Written whole by
/// the servo thread each tick; read by the renderer and by a virtual subject, so both see the same.
/// Source: Morris 2006, §4.2.4, Figure 24.
struct Presentation {
  Eigen::Vector3d tool{Eigen::Vector3d::Zero()};  // device position in W [m]
  bool show_trajectory{false};   // the spatial trajectory of the block and the tool on it
  bool show_target_bar{false};   // blue bar: target normal force
  bool show_applied_bar{false};  // green bar: normal force that the participant applies
  bool show_saturation{false};   // small square: the device is at its force limit
  double target_force{0.0};      // [N]; 0 where its bar is hidden
  double applied_force{0.0};     // [N]; 0 where its bar is hidden
  double progress{0.0};          // along the path as a fraction, 0 before and 1 after the run
  double pass_duration{0.0};     // of the run; where it is self-paced, at the path's own speed [s]
  bool self_paced{false};        // the participant moves along the path, now
  Eigen::Vector3d direction{Eigen::Vector3d::Zero()};  // on along the path, while self-paced
  std::int32_t block{0};                               // changes with the stimulus
  Instruction instruction{Instruction::kRest};

  bool engaged() const noexcept { return instruction != Instruction::kRest; }
};

/// The path's part of a view; nothing but the tool if nothing or something else is shown.
inline Presentation presentation_of(const Shown& shown) noexcept {
  if (const auto* seen = shown.as<Presentation>()) {
    return *seen;
  }
  Presentation nothing;
  nothing.tool = shown.tool;
  return nothing;
}

}  // namespace haptrial::stimulus
