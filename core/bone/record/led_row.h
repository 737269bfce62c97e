#pragma once

#include <Eigen/Geometry>
#include <cstdint>

#include "core/base/point_state.h"
#include "core/record/table/table.h"

namespace haptrial::record {

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

}  // namespace haptrial::record
