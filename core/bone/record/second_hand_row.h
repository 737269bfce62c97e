#pragma once

#include <Eigen/Geometry>
#include <cstdint>

#include "core/record/table/table.h"

namespace haptrial::record {

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

}  // namespace haptrial::record
