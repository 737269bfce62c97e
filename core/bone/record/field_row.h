#pragma once

#include <Eigen/Core>
#include <cstdint>

#include "core/record/table/table.h"

namespace haptrial::record {

/// A vessel that was opened on a tick, a row of /openings. Goes through a block log.
struct OpeningRow {
  std::uint64_t sequence{0};                       // of the tick
  std::uint8_t label{0};                           // of the structure
  Eigen::Vector3d place{Eigen::Vector3d::Zero()};  // in B [m]
};

/// Clearness of the field up to the end of a pass, since the bone was new, a row of /field.
struct FieldRow {
  std::int32_t pass{0};      // row of /trials
  double bled{0.0};          // [m3]
  double blood_sucked{0.0};  // [m3]
  double blood_lying{0.0};   // [m3]
  double hottest{0.0};       // at the burr; 0: nothing warms up [degree C]
  double harmful_time{0.0};  // above the temperature that harms [s]
};

template <>
const Table<OpeningRow>& table_of<OpeningRow>();
template <>
const Table<FieldRow>& table_of<FieldRow>();

}  // namespace haptrial::record
