#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>

#include "core/record/table/table.h"

namespace haptrial::record {

/// A piece of bone that was born, or that a hand carries or has let go of, a row of /pieces. Goes
/// through a block log.
struct PieceRow {
  std::uint64_t sequence{0};  // of the tick
  std::int32_t piece{0};
  std::int64_t voxels{0};  // when it was born; 0 in rows of its motion
  /// The piece has moved since the procedure began: a point p of it is at R(turn) p + shift in W.
  Eigen::Vector3d shift{Eigen::Vector3d::Zero()};  // [m]
  Eigen::Vector3d turn{Eigen::Vector3d::Zero()};   // rotation vector [rad]
};

/// A screw whose driving ended, a row of /screws; a later row of the same hole replaces it, as that
/// of depth 0 when its plate comes off. Goes through a block log.
struct ScrewRow {
  std::uint64_t sequence{0};
  std::int32_t tool{0};   // that drove it
  std::int32_t plate{0};  // from 0, in the order in which plates were fixed
  std::int32_t hole{0};   // of the plate, from 0
  std::int32_t piece{0};  // that its thread met last; -1: none
  double depth{0.0};      // of its tip below the plate [m]
  double purchase{0.0};   // length of solid bone that its thread is in [m]
  double torque{0.0};     // [N·m]
};

template <>
const Table<PieceRow>& table_of<PieceRow>();
template <>
const Table<ScrewRow>& table_of<ScrewRow>();

}  // namespace haptrial::record
