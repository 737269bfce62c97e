#pragma once

#include <span>
#include <vector>

#include "core/nerve/record/nerve_rows.h"
#include "core/record/rows/session_types.h"
#include "core/stream/lsl_outlet.h"

namespace haptrial::stream {

/// Electromyograms of a nerve monitor on the stream, each sample at its place between two ticks.
/// Session's thread.
class StreamNerves {
 public:
  /// @param outlet    null: nothing is sent; outlives this
  /// @param channels  that are sent  @param rate  of their samples [Hz]
  StreamNerves(LslOutlet* outlet, std::size_t channels, double rate)
      : outlet_(outlet), channels_(channels), rate_(rate) {}

  /// Rows wait for the samples of their ticks, which say when these were.
  void add(std::span<const record::EmgRow> rows);
  void follow(std::span<const record::Sample> samples);

 private:
  LslOutlet* outlet_;
  std::size_t channels_;
  double rate_;
  std::vector<record::EmgRow> waiting_;
  std::vector<double> values_;
  std::vector<double> times_;
};

}  // namespace haptrial::stream
