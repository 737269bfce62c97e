#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/realtime/block_log.h"
#include "core/record/table/table.h"

namespace haptrial::record {

/// A burr's way through a forbidden region, a row of /crossings. Goes through a block log.
struct CrossingRow {
  std::uint64_t sequence{0};  // of the last tick in it
  std::uint64_t begin{0};     // of the first
  std::uint8_t label{0};      // of the structure
  bool given{false};          // the participant felt or heard it; else only recorded
  double depth{0.0};          // greatest, of the burr's surface in the margin [m]
};

template <>
const Table<CrossingRow>& table_of<CrossingRow>();

}  // namespace haptrial::record

namespace haptrial::bone {

/// Turns depths in regions, tick by tick, into crossings. Servo thread: no allocation.
class CrossingWatch {
 public:
  /// @param labels  of the structures
  explicit CrossingWatch(std::vector<std::uint8_t> labels);

  /// @param given   whether the participant feels or hears the regions
  /// @param depths  (structures) 0: outside [m]
  /// @returns whether the burr has just entered a region
  bool after_tick(std::uint64_t sequence, bool given, std::span<const double> depths,
                  realtime::BlockLog<record::CrossingRow>& log) noexcept;
  /// Ends the crossings that are on; while no drilling ticks, or on the servo thread.
  void end(realtime::BlockLog<record::CrossingRow>& log) noexcept;

 private:
  struct Crossing {
    bool on{false};
    record::CrossingRow row;
  };
  std::vector<Crossing> crossings_;  // (structures)
};

}  // namespace haptrial::bone
