#pragma once

#include <Eigen/Core>
#include <cstdint>

#include "core/record/table/table.h"

namespace haptrial::record {

/// One tick during which a tutor leads the first device's tool, a row of /tutoring.
struct TutoringRow {
  std::uint64_t sequence{0};  // of the tick, as in /samples
  double time{0.0};           // in what the tutor did, from the beginning of his run [s]
  double lead{0.0};           // the tutor's authority, 0 to 1
  Eigen::Vector3d position{Eigen::Vector3d::Zero()};      // of the tutor's tool, in W [m]
  Eigen::Vector3d tutor_force{Eigen::Vector3d::Zero()};   // on it, in W [N]
  Eigen::Vector3d played_force{Eigen::Vector3d::Zero()};  // of the tutor on the own tool, in W [N]
};

template <>
const Table<TutoringRow>& table_of<TutoringRow>();

}  // namespace haptrial::record
