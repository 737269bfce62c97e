#pragma once

#include <Eigen/Core>
#include <cstdint>

#include "core/record/table/table.h"

namespace haptrial::record {

/// One tick of a tool on an object whose contact is recorded, a row of /contacts. Ticks without
/// contact have none.
struct ContactRow {
  std::uint64_t sequence{0};                       // of the tick, as in /samples
  std::int32_t device{0};                          // whose tool, from 0
  std::int32_t object{0};                          // of [objects] in the order of names, from 0
  bool sliding{false};                             // else friction holds the tool's proxy
  double depth{0.0};                               // of the tool behind the surface [m]
  Eigen::Vector3d proxy{Eigen::Vector3d::Zero()};  // in W [m]
  Eigen::Vector3d force{Eigen::Vector3d::Zero()};  // on the tool, in W [N]
  double work{0.0};                                // see /contacts [J]
};

template <>
const Table<ContactRow>& table_of<ContactRow>();

}  // namespace haptrial::record
