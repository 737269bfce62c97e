#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/record/rows/session_types.h"
#include "core/stream/lsl_outlet.h"

namespace haptrial::stream {

/// Rows of a protocol's table on their side stream, each at its place after its tick.
/// Session's thread.
class StreamRows {
 public:
  /// @param outlet  null: nothing is sent; outlives this
  /// @param stream  what is sent; its number among the outlet's side streams follows
  StreamRows(LslOutlet* outlet, SideStream stream, std::size_t number)
      : outlet_(outlet), stream_(std::move(stream)), number_(number) {}

  /// Rows wait for the samples of their ticks, which say when these were.
  void add(const record::Rows& rows);
  void follow(std::span<const record::Sample> samples);

 private:
  struct Waiting {
    std::uint64_t sequence{0};
    double after{0.0};  // [s]
  };

  LslOutlet* outlet_;
  SideStream stream_;
  std::size_t number_;
  std::vector<Waiting> waiting_;
  std::vector<double> values_;  // (waiting x channels)
  std::vector<double> sent_;    // likewise
  std::vector<double> times_;
};

}  // namespace haptrial::stream
