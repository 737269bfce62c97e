#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstdint>
#include <string>

#include "core/base/point_state.h"
#include "core/record/table/table.h"

namespace haptrial::record {

/// The four columns of an orientation, orientation_w to orientation_z.
template <class Row>
typename Table<Row>::Columns turn_columns(Eigen::Quaterniond Row::*of, const char* description) {
  using T = Table<Row>;
  typename T::Columns all;
  const auto add = [&](typename T::Columns one) { all.insert(all.end(), one.begin(), one.end()); };
  constexpr double kTurn = kOrientationResolution;
  add(T::rounded(
      "orientation_w", [of](Row& r) -> double& { return (r.*of).w(); }, "1", description, kTurn));
  add(T::rounded(
      "orientation_x", [of](Row& r) -> double& { return (r.*of).x(); }, "1", "likewise", kTurn));
  add(T::rounded(
      "orientation_y", [of](Row& r) -> double& { return (r.*of).y(); }, "1", "likewise", kTurn));
  add(T::rounded(
      "orientation_z", [of](Row& r) -> double& { return (r.*of).z(); }, "1", "likewise", kTurn));
  return all;
}

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

/// The tube in the other hand on one tick, a row of /second_hand, beside /devices, which has its
/// position, velocity, buttons and the force that was commanded. Goes through a block log.
struct SecondHandRow {
  std::uint64_t sequence{0};
  Eigen::Quaterniond orientation{Eigen::Quaterniond::Identity()};  // as the device gave it, in W
  bool sucks{false};
  bool rinses{false};
  std::int32_t immersed{0};                          // samples of its end in bone
  Eigen::Vector3d contact{Eigen::Vector3d::Zero()};  // force before any limit, in W [N]
};

/// How the two hands' tools push each other on one tick, a row of /tool_contact; only of sessions
/// whose tools do. Goes through a block log.
struct ToolContactRow {
  std::uint64_t sequence{0};
  Eigen::Vector3d force{Eigen::Vector3d::Zero()};  // on the first hand's, in W [N]
};

template <>
const Table<SecondHandRow>& table_of<SecondHandRow>();
template <>
const Table<ToolContactRow>& table_of<ToolContactRow>();

/// One tick of another session that this session's bone has followed, a row of /led: what its
/// device gave. Several may be followed on one tick of the own. Goes through a block log.
struct LedRow {
  std::uint64_t sequence{0};  // of the own tick
  std::uint64_t step{0};      // of the bone, from 1 when it was new
  bool begins{false};         // the first one of a pass of the other session
  PointState tool;            // in W
  Eigen::Quaterniond orientation{Eigen::Quaterniond::Identity()};  // in W
  std::uint32_t buttons{0};
  std::uint32_t keys{0};
  double pedal{0.0};
};

template <>
const Table<LedRow>& table_of<LedRow>();

/// A key that was tuned while a pilot ran, a row of /tuning.
struct TuningRow {
  std::uint64_t sequence{0};  // of the first tick with the new value
  std::string key;            // path in the definition
  double before{0.0};         // in the key's unit
  double after{0.0};          // likewise
};

template <>
const Table<TuningRow>& table_of<TuningRow>();

}  // namespace haptrial::record
