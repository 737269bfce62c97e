#pragma once

#include <Eigen/Core>
#include <cstdint>

#include "core/record/table/table.h"

namespace haptrial::record {

/// The cursor on one tick, a row of /cursor, where it moves otherwise than the tool.
struct CursorRow {
  std::uint64_t sequence{0};                       // of the tick, as in /samples
  Eigen::Vector3d place{Eigen::Vector3d::Zero()};  // in W [m]
  bool shown{false};
};

template <>
const Table<CursorRow>& table_of<CursorRow>();

}  // namespace haptrial::record
