#pragma once

#include <memory>
#include <vector>

#include "core/base/definition/schema_forward.h"
#include "core/device/five_bar.h"
#include "core/device/serial_board.h"

namespace haptrial::device {

/// How a board that speaks Haply's hAPI is set up. The defaults are those of a 2diy of plastic.
struct HapiParameters {
  enum class Mechanism { kPantograph, kLever };
  enum class Firmware { kCurrent, kPorts };
  enum class Side { kFar, kNear, kBelow, kAbove };

  SerialBoardSetup line;
  Firmware firmware{Firmware::kCurrent};        // kPorts: of 2017, which names ports in its header
  Mechanism mechanism{Mechanism::kPantograph};  // kLever: one motor, as of a Haplet
  FiveBar bars;                                 // of a lever the arm alone
  Side motors{Side::kFar};                      // seen by who holds the handle
  std::vector<double> center{0.019, 0.1};       // of the workspace in the pantograph's plane [m]
  std::vector<double> ports{2, 1};              // of motor and encoder 1 and 2
  std::vector<double> clockwise{};              // numbers of the motors that turn clockwise
  std::vector<double> encoder_offset{168.0, 12.0};  // angles at which the handle starts [deg]
  double encoder_resolution{4880.0};                // > 0 [counts/turn]
};

/// The keys of [hapi].
const Schema<HapiParameters>& hapi_schema();

/// Messages of hAPI, with numbers as float32 in little-endian order, motors in the order of their
/// ports. The current firmware takes
///
///     1, id, ports, directions, ports, directions, 0, 0, (offset [deg], counts a turn)…   set-up
///     2, id, torque [N·m]…                                                               force
///
/// (ports a bit each; first motors, then encoders), that of 2017
///
///     0 << 4 | ports, id, (offset, counts a turn)…  and  1 << 4 | ports, id, torque…
///
/// Both answer a force with id, angle [deg]…. A force takes the torques J^T f at the angles that
/// were read last; where the mechanism defines no force (FiveBarPose) they are zero, and the
/// reading says so.
std::unique_ptr<BoardProtocol> hapi_protocol(const HapiParameters& parameters);

/// Axes of W along which the board gives force, as in DeviceInfo.
Eigen::Vector3d force_axes(const HapiParameters& parameters);

/// @throws as SerialBoard does
std::unique_ptr<SerialBoard> open_hapi_board(const HapiParameters& parameters, double rate);

}  // namespace haptrial::device
