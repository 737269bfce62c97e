#pragma once

#include <cstddef>
#include <map>
#include <span>
#include <string>
#include <vector>

#include "core/record/rows/marker_row.h"

namespace haptrial::markers {

/// How soon the markers of one way had gone after the ticks of their onsets.
struct MarkerTimes {
  record::MarkerOutput way{record::MarkerOutput::kSerial};
  std::size_t sent{0};
  std::size_t lost{0};  // did not go
  // The smallest latencies that a half, 99 % and all of those sent do not exceed [s]; NaN: none
  // was.
  double median{0.0};
  double p99{0.0};
  double largest{0.0};
};

/// Gathers the markers of one session or several. One thread.
class MarkerLatencies {
 public:
  void add(std::span<const record::MarkerRow> rows);
  void add(const MarkerLatencies& others);
  /// One for each way that markers went, in the order of MarkerOutput, without kNone.
  std::vector<MarkerTimes> times() const;

 private:
  struct OutputDelays {
    std::vector<double> latencies;  // [s]
    std::size_t lost{0};
  };
  std::map<record::MarkerOutput, OutputDelays> outputs_;
};

/// "serial: 240 markers, median 0.031 ms, 99 % 0.102 ms, largest 0.400 ms after their tick".
std::string sentence_of(const MarkerTimes& times);

}  // namespace haptrial::markers
