#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "core/device/device.h"
#include "core/realtime/servo_loop.h"
#include "core/record/hdf5/session_writer.h"
#include "core/record/recovery/session_resume.h"
#include "core/record/rows/live_figures.h"
#include "core/stream/lsl_outlet.h"
#include "experiments/runner/session_markers.h"
#include "experiments/runner/session_request.h"
#include "experiments/runner/sinks.h"
#include "protocols/interface/session_file.h"
#include "protocols/interface/session_task.h"
#include "protocols/interface/trials.h"

namespace haptrial::experiments {

/// Record and streams of a session: the records of its servo thread, passes, answers, events,
/// stimuli, frames and timing; everything that is recorded goes to one list of sinks. Session's
/// thread. Every member throws RunError when the file cannot be written.
class SessionRecord final : public protocols::SessionFile {
 public:
  /// Opens the session file, or goes on with it, and the streams.
  /// @param loop    whose ticks are recorded and give events their time; outlives the record
  /// @param trials  of the session; outlive the record
  /// @param onsets  of the servo thread; outlive the record
  /// @param channels  of the session; outlive the record
  /// @param live    gets what is recorded, or null; outlives the record
  SessionRecord(const SessionRequest& request, const device::DeviceInfo& device,
                const realtime::ServoLoop& loop, protocols::Trials& trials,
                markers::OnsetLog& onsets, channel::ChannelSet& channels,
                record::LiveFigures* live);

  /// Log in which the servo thread leaves its records.
  protocols::SessionTask::Log& log() { return log_; }
  protocols::SessionTask::DeviceLog& device_log() { return device_log_; }
  /// Origin of the first tick of this run.
  protocols::Origin origin() const;
  std::uint64_t dropped() const;
  /// Why there are no streams though they were asked for, in a sentence; else empty.
  const std::string& notice() const { return notice_; }
  SessionMarkers& markers() { return markers_; }

  /// Contents of a resumed file; see earlier_run.h.
  const record::Resumed& earlier() const { return before_; }
  /// The first event, after rows for the passes during which an earlier run ended.
  void open(const std::string& text);
  /// The hand did not carry all the damping in the pass that ended.
  /// @param least  smallest share of it  @param seconds  for which it was reduced
  void note_damping(double least, double seconds);
  /// The trial was skipped for good: it does not come again, not after a resume either.
  void skip(const protocols::PlannedTrial& trial);
  /// The answers of these passes, rows of /trials, do not count.
  void take_back(std::int32_t trial, std::span<const std::int32_t> passes);
  void keep_stimulus(std::int32_t block, std::span<const record::StimulusRow> rows) override;
  bool holds_stimulus(std::int32_t block) const override;
  const std::vector<record::PassRow>& earlier_passes() const override { return before_.passes; }
  bool was_cut_short(const protocols::PlannedTrial& trial) const override;
  /// An answer to a page; its time is filled in.
  void keep_answer(record::AnswerRow row);
  /// Answers of the pass that has ended, before its row.
  void keep_responses(std::vector<record::ResponseRow> rows);

  /// @returns the number of its row, for its samples.
  std::int32_t begin_pass(const protocols::PlannedTrial& trial, const record::Phase& phase,
                          int attempt);
  /// The present pass, or the last one.
  const record::PassRow& pass() const { return row_; }
  void end_pass(const protocols::PassResult& result);

  /// Takes the records of the servo thread since the last call, and shows them to `follow`.
  /// @returns the number of records.
  using Follower = std::function<void(std::span<const record::Sample>)>;
  std::size_t collect(const Follower& follow);
  bool in_pass() const { return row_open_; }
  /// The time of a tick of the present pass, since the session's first tick [ns]; now, if the pass
  /// has no such tick.
  std::int64_t time_of(std::uint64_t sequence) const;
  /// A time since this run's first tick, since the session's.
  std::int64_t session_time(std::int64_t time_ns) const { return start_ns_ + time_ns; }
  /// @param frames  with times since this run's first tick
  void keep_frames(std::vector<record::FrameRow> frames);
  void event(const std::string& kind, const std::string& text) override;
  /// An event that was noticed later than it happened. @param time_ns  since the session's first
  /// tick
  void event_at(std::int64_t time_ns, const std::string& kind, const std::string& text);
  /// Marks a trial on the stream only: the file's tables have it already. @param status  empty:
  /// none yet
  void mark_trial(const std::string& kind, const protocols::PlannedTrial& trial, int attempt,
                  const std::string& status = "");

  /// @param trials  of the study that this run is to present. Call before open().
  void set_planned(std::ptrdiff_t trials) {
    writer_.set_planned(static_cast<std::int32_t>(trials));
  }
  /// Ends the record after the loop's end, if trials are left for another run: FILE.partial stays.
  void stop(const std::string& text);
  /// Ends the record after the loop's end with the last event and the timing; the file is complete.
  void close(const std::string& text);
  /// Ends the record after the loop's end, if the session did not come to its own: a simulated
  /// session, or one without a tick, leaves nothing, another leaves FILE.partial, with its open
  /// pass as aborted.
  void give_up(const protocols::SessionTask& task);

 private:
  void put(const record::Rows& batch) override;
  std::int64_t now_ns() const;
  void mark(const std::string& text);
  void keep_definition();
  void append(std::span<const record::Sample> samples);
  void append_rest();
  void keep_channels();
  void keep_markers(bool last);
  void add_pass(record::PassStatus status, std::uint64_t first_sample, std::uint64_t last_sample);
  void tell_notices();
  void note_plan();
  void tell_what_was_kept();
  record::TimingSummary counts() const;
  void write_timing(record::RunState state);

  const SessionRequest& request_;
  const realtime::ServoLoop& loop_;
  const bool real_;
  record::Resumed before_;  // what a resumed file holds
  // This member stands before the writer: without the streams that it needs a session leaves no
  // file.
  std::string notice_;
  std::unique_ptr<stream::LslOutlet> outlet_;
  SessionMarkers markers_;
  record::SessionWriter writer_;
  FileSink file_;
  StreamSink stream_;
  std::vector<record::Sink*> sinks_;
  protocols::Trials& trials_;
  channel::ChannelSet& channels_;
  protocols::SessionTask::Log log_;
  protocols::SessionTask::DeviceLog device_log_;
  std::vector<std::int32_t> blocks_;  // whose stimuli are in the file
  record::PassRow row_;
  record::PassRow last_;             // the pass before, of an earlier run too
  std::int64_t start_ns_{0};         // of this run
  std::vector<std::int64_t> times_;  // of the ticks of the present pass [ns]
  std::uint64_t first_time_{0};      // sequence number of the first of them
  bool row_open_{false};             // and is not in the file yet
  std::int32_t passes_{0};
  std::chrono::steady_clock::time_point flushed_{};
};

}  // namespace haptrial::experiments
