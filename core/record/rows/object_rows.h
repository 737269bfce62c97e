#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <string>

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

/// How a body that moves did so in a pass, a row of /moving_bodies. Counts are ticks.
struct MovingBodyRow {
  std::int32_t pass{0};          // row of /trials
  std::int32_t device{0};        // whose tool, from 0
  std::string object;            // its name
  std::int32_t steps{0};         // of the body on a tick
  std::uint64_t limited{0};      // the force was cut, or it might have given out energy
  std::uint64_t flown_apart{0};  // it flew apart and was put to rest
};

template <>
const Table<MovingBodyRow>& table_of<MovingBodyRow>();

/// How the contact with a body that gives way went in a pass, a row of /touched_bodies. Counts are
/// ticks.
struct TouchedBodyRow {
  std::int32_t pass{0};        // row of /trials
  std::int32_t device{0};      // whose tool, from 0
  std::string object;          // its name
  std::uint64_t contact{0};    // in contact
  std::uint64_t inverted{0};   // a tetrahedron would be inside out: the force stayed below that
  std::uint64_t unsettled{0};  // the places of contact were not found to rounding
  std::uint64_t crowded{0};    // more places than fit: the deepest were taken
};

template <>
const Table<TouchedBodyRow>& table_of<TouchedBodyRow>();

/// A window that a body of its own rate did not end in time, a row of /late_windows: what was felt
/// until then came from the window before. With these rows a replay feels the same.
struct LateWindowRow {
  std::int32_t pass{0};      // row of /trials
  std::int32_t device{0};    // whose tool, from 0
  std::int32_t interval{1};  // of the trial, from 1
  std::string object;        // its name
  std::uint64_t tick{0};     // of the body, from 0: on which the window was taken
  std::uint64_t ticks{0};    // too late
};

template <>
const Table<LateWindowRow>& table_of<LateWindowRow>();

/// A file of an object or a sound as it was when the session began, a row of /object_files.
struct ObjectFileRow {
  std::int32_t object{0};     // of [objects] in the order of names, from 0; -1: of a sound
  std::string name;           // of the object; of a sound "sounds.beep"
  std::string file;           // as the definition names it
  std::uint64_t bytes{0};     // its size
  std::uint64_t checksum{0};  // FNV-1a of its bytes

  /// As definitions call it, "objects.ball".
  std::string key() const { return object < 0 ? name : "objects." + name; }
};

template <>
const Table<ObjectFileRow>& table_of<ObjectFileRow>();

}  // namespace haptrial::record
