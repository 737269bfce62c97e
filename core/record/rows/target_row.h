#pragma once

#include <Eigen/Core>
#include <cstdint>

#include "core/record/table/table.h"

namespace haptrial::record {

/// A moving target on one tick on which a stage shows it, a row of /targets.
struct TargetRow {
  std::uint64_t sequence{0};                       // of the tick, as in /samples
  std::int32_t target{0};                          // of [targets] in the order of names, from 0
  Eigen::Vector3d place{Eigen::Vector3d::Zero()};  // in W [m]
};

template <>
const Table<TargetRow>& table_of<TargetRow>();

}  // namespace haptrial::record
