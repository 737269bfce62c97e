#pragma once

#include <Eigen/Geometry>
#include <cstdint>

namespace haptrial::stimulus {

/// What the participant has been told to do in this pass.
enum class Instruction : std::uint8_t {
  kRest,       // no task
  kHoldPlane,  // keep the device in the plane against its force (haptic training)
  kWatch,      // watch the target bar (visual training)
  kMatch,      // make the applied bar as high as the target bar (visuohaptic training)
  kRecall,     // apply the learnt pattern (test)
  kDrill,      // work on the bone
};

/// What there is to see of a drilling beside the bone itself, which the screen follows by itself.
struct DrillingView {
  bool shown{false};
  Eigen::Vector3d tip{Eigen::Vector3d::Zero()};  // of the tool, in the scene's W [m]
  Eigen::Quaterniond orientation{
      Eigen::Quaterniond::Identity()};            // of the tool in W, z to the hand
  std::int32_t tool{0};                           // in hand
  bool power{false};                              // it turns, or sucks
  bool contact{false};                            // it touches bone
  double sound_force{0.0};                        // what can be heard of it [N]
  Eigen::Vector3d eye{Eigen::Vector3d::UnitZ()};  // in W [m]
  Eigen::Vector3d target{Eigen::Vector3d::Zero()};
  Eigen::Vector3d up{Eigen::Vector3d::UnitY()};
  double field_of_view{0.35};    // [rad]
  std::int32_t stills_asked{0};  // how often the next still was asked for
};

/// What the participant is to see at one instant. Written whole by the servo thread each tick; read
/// by the renderer and by a virtual subject, so both see the same thing.
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
  DrillingView drilling;
};

}  // namespace haptrial::stimulus
