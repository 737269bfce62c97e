#pragma once

#include <vector>

#include "core/record/hdf5/session_writer.h"
#include "core/record/rows/sink.h"
#include "core/stream/lsl_outlet.h"
#include "core/stream/stream_rows.h"
#include "experiments/runner/stream_markers.h"

namespace haptrial::experiments {

/// Sink into the session file.
class FileSink final : public record::Sink {
 public:
  /// @param writer  outlives the sink
  explicit FileSink(record::SessionWriter& writer) : writer_(writer) {}
  void rows(const record::Rows& rows) override;
  void samples(std::span<const record::Sample> samples) override { writer_.append(samples); }
  void end_pass(const record::PassRow& pass) override { writer_.add_pass(pass); }
  void event(const record::EventRow& event) override { writer_.add_event(event); }

 private:
  record::SessionWriter& writer_;
};

/// Sink to the Lab Streaming Layer, with markers; nothing goes out without an outlet.
class StreamSink final : public record::Sink {
 public:
  /// @param outlet  may be null; outlives the sink
  /// @param sides  side streams of the outlet, in its order
  StreamSink(stream::LslOutlet* outlet, const std::vector<stream::SideStream>& sides);
  void begin_pass(const record::PassRow& pass, std::int32_t) override { pass_ = pass; }
  void rows(const record::Rows& rows) override;
  void samples(std::span<const record::Sample> samples) override;
  void end_pass(const record::PassRow& pass) override { markers_.end_pass(pass); }
  void event(const record::EventRow& event) override;

 private:
  stream::LslOutlet* outlet_;
  StreamMarkers markers_;
  std::vector<stream::StreamRows> sides_;
  record::PassRow pass_;
};

}  // namespace haptrial::experiments
