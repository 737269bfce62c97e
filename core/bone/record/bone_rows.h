#pragma once

#include <Eigen/Core>
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
