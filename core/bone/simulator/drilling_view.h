#pragma once

#include <Eigen/Geometry>
#include <array>
#include <cstdint>

#include "core/bone/model/dent.h"
#include "core/bone/simulator/injury_watch.h"

namespace haptrial::bone {

/// Drawn state of the tube in the other hand.
struct TubeView {
  bool shown{false};
  Eigen::Vector3d tip{Eigen::Vector3d::Zero()};  // in W [m]
  Eigen::Quaterniond orientation{Eigen::Quaterniond::Identity()};
  bool sucks{false};
  bool rinses{false};
};

/// Drawn state of a drilling beside the bone itself, which the screen follows by itself: a view
/// (core/stimulus/shown.h).
struct DrillingView {
  bool shown{false};
  Eigen::Vector3d tip{Eigen::Vector3d::Zero()};  // of the tool, in the scene's W [m]
  Eigen::Quaterniond orientation{
      Eigen::Quaterniond::Identity()};            // of the tool in W, z to the hand
  std::int32_t tool{0};                           // in hand
  bool power{false};                              // it turns, or sucks
  bool reversed{false};                           // burrs turn against their rotation
  double sharpness{1.0};                          // of the tool, 1 down to 0
  double turned{0.0};                             // as it is drawn, a share of a turn
  bool contact{false};                            // it touches bone
  double sound_force{0.0};                        // what can be heard of it [N]
  Eigen::Vector3d eye{Eigen::Vector3d::UnitZ()};  // in W [m]
  Eigen::Vector3d target{Eigen::Vector3d::Zero()};
  Eigen::Vector3d up{Eigen::Vector3d::UnitY()};
  double field_of_view{0.35};      // [rad]
  std::int32_t stills_asked{0};    // how often the next still was asked for
  bool tone{false};                // the participant hears one of a nerve monitor
  std::uint8_t hints{0};           // that are shown, hint::bit() of each kind
  std::int8_t hint_structure{-1};  // of vital_structures(), that they are about; -1: none
  LastInjury injury;
  TubeView tube;
  std::array<Dent, 2> dents{};  // of soft tissue in the bone itself, by tool and tube
  double temperature{0.0};      // at the burr; 0: nothing warms up [degree C]
  double elapsed{0.0};          // since the bone was new [s]
  double progress{0.0};         // of the time limit, as a fraction
  double time_limit{0.0};       // [s]

  bool engaged() const noexcept { return shown; }
};

}  // namespace haptrial::bone
