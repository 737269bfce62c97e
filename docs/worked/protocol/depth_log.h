#pragma once

#include <algorithm>

#include "core/realtime/block_log.h"
#include "core/record/table/table.h"
#include "core/stream/side_stream.h"
#include "protocols/interface/pass.h"

inline constexpr int kTicksADepth = 10;

/// How deep a spring is pressed, at every tenth tick: a table of the session's file, and a stream
/// beside its samples.
struct DepthRow {
  std::uint64_t sequence{0};  // of the tick
  double depth{0.0};          // [m]
};

class DepthLog final : public haptrial::protocols::TickLog {
 public:
  haptrial::realtime::BlockLog<DepthRow> rows;
  void record(std::uint64_t sequence, const haptrial::protocols::Readings& readings,
              haptrial::device::Fault) noexcept override {
    if (sequence % kTicksADepth == 0) {
      rows.push({sequence, std::max(0.0, -readings[0].tool.position.y())});
    }
  }
};

/// @param rate  of ticks [Hz]
inline haptrial::stream::SideStream depth_stream(double rate) {
  haptrial::stream::SideStream side;
  side.name = "depth";
  side.type = "Position";
  side.unit = "m";
  side.channels = {"depth"};
  side.rate = rate / kTicksADepth;
  side.read = haptrial::stream::reads_rows<DepthRow>([](const DepthRow& row) {
    return haptrial::stream::SideSample{row.sequence, 0.0, std::span(&row.depth, 1)};
  });
  return side;
}
