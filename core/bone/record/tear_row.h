#pragma once

#include <Eigen/Core>
#include <cstdint>

#include "core/record/table/table.h"

namespace haptrial::record {

inline constexpr std::int32_t kSecondHand = -1;  // the tube in the other hand

/// Soft tissue that was torn on a tick, a row of /tears. Goes through a block log.
struct TearRow {
  std::uint64_t sequence{0};                       // of the tick
  std::uint8_t label{0};                           // of the structure
  std::int32_t tool{0};                            // in hand, from 0, or kSecondHand
  bool by_suction{false};                          // else pressed by the tool
  double force{0.0};                               // [N]
  double depth{0.0};                               // how far it had given way [m]
  Eigen::Vector3d place{Eigen::Vector3d::Zero()};  // on its surface at rest, in B [m]
};

template <>
const Table<TearRow>& table_of<TearRow>();

}  // namespace haptrial::record
