#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "core/record/hdf5/session_writer.h"
#include "core/record/rows/rows.h"
#include "core/record/rows/session_types.h"
#include "core/stream/lsl_outlet.h"
#include "core/stream/stream_rows.h"

namespace haptrial::experiments {

/// Markers of passes and their stages on the stream, each at the time of the tick with which it
/// began or ended (docs/devices.md lists them). Session's thread.
class StreamMarkers {
 public:
  /// @param outlet  null: nothing is marked; outlives the markers
  explicit StreamMarkers(stream::LslOutlet* outlet) : outlet_(outlet) {}

  /// Samples in their order, before those of another pass; `row` is the pass that is under way.
  void follow(std::span<const record::Sample> samples, const record::PassRow& row);
  /// Marks the end of a pass after its last sample; a pass without samples has no mark.
  void end_pass(const record::PassRow& row);

 private:
  void mark(const char* kind, const record::PassRow& row, const std::string& more) const;

  stream::LslOutlet* outlet_;
  std::int32_t pass_{-1};  // that is under way
  record::Stage stage_{record::Stage::kIdle};
  std::int64_t time_ns_{0};  // of its latest sample
};

/// "trial=3 practice=0 attempt=1 block=1 repetition=3 condition=haptic": fields of a marker.
std::string marker_fields(const record::PassRow& row);

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
