#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <string>

#include "core/record/table/table.h"

namespace haptrial::record {

/// A burr of the session as it was when it was new, a row of /burrs.
struct BurrRow {
  std::int32_t tool{0};  // of /tool
  std::string name;
  std::uint8_t kind{0};         // 0 diamond, 1 cutting
  std::uint8_t shape{0};        // 0 ball, 1 cylinder, 2 cone, 3 pear
  double diameter{0.0};         // the greatest [m]
  double length{0.0};           // along the axis [m]
  double narrow_diameter{0.0};  // of its narrow end [m]
  bool clockwise{true};         // turns so, seen from the handle, unless it is reversed
  double shaft_radius{0.0};     // of the shaft that is felt; 0: it is not felt [m]
  double shaft_length{0.0};     // likewise [m]
  double wear_volume{0.0};      // of bone, after which it removes half as much; 0: never [m3]
};

/// The handpiece on one tick, a row of /handpiece. Goes through a block log.
struct HandpieceRow {
  std::uint64_t sequence{0};
  bool reversed{false};                                 // burrs turn against their rotation
  double sharpness{1.0};                                // of the tool in hand
  Eigen::Vector3d shaft{Eigen::Vector3d::Zero()};       // of bone on its shaft, in W [N]
  Eigen::Vector3d tube_shaft{Eigen::Vector3d::Zero()};  // on the tube of the other hand, in W [N]
};

template <>
const Table<BurrRow>& table_of<BurrRow>();
template <>
const Table<HandpieceRow>& table_of<HandpieceRow>();

}  // namespace haptrial::record
