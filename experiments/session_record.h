#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/device/device.h"
#include "core/realtime/servo_loop.h"
#include "core/record/session_resume.h"
#include "core/record/session_writer.h"
#include "core/stimulus/stimulus.h"
#include "core/stream/lsl_outlet.h"
#include "experiments/session.h"
#include "experiments/stream_markers.h"
#include "protocols/drilling_pass.h"
#include "protocols/schedule.h"
#include "protocols/session_task.h"

namespace haptrial::experiments {

class LiveDrilling;

/// What a session writes and streams: the records of its servo thread, passes, events, stimuli,
/// frames and timing. Session's thread. Every member throws RunError when the file cannot be
/// written.
class SessionRecord {
 public:
  /// Opens the session file, or goes on with it, and the streams.
  /// @param loop  whose ticks are recorded and give events their time; outlives the record
  /// @param bones  of a session that drills
  /// @param live   measures the drillings, or null; outlives the record
  SessionRecord(const SessionRequest& request, const device::DeviceInfo& device,
                const realtime::ServoLoop& loop,
                const std::optional<std::vector<record::BoneRecord>>& bones, LiveDrilling* live);

  /// Where the servo thread leaves its records.
  protocols::SessionTask::Log& log() { return log_; }
  /// Likewise of a session that drills; null in others.
  protocols::SessionTask::ToolLog* tool_log() { return drilling_ ? &drilling_->tool : nullptr; }
  /// Only in a session that drills.
  protocols::DrillingLogs& drilling_logs() { return drilling_->logs; }
  void keep_procedure(const record::ProcedureRow& row) { writer_.add(std::span(&row, 1)); }
  /// Of the first tick of this run.
  protocols::Origin origin() const;
  std::uint64_t dropped() const;
  /// Why there are no streams though they were asked for, in a sentence; else empty.
  const std::string& notice() const { return notice_; }

  /// The first event, after rows for the passes during which an earlier run ended.
  /// @param drilled  the trial that was under way, of a session that drills; else null
  void open(const std::string& text, const protocols::PlannedTrial* drilled);
  /// Whether a resumed file holds the trial's last pass already, or says that it was skipped.
  bool holds(const protocols::PlannedTrial& trial, record::Phase last) const;
  /// The trial was skipped for good: it does not come again, not after a resume either.
  void skip(const protocols::PlannedTrial& trial);
  /// How many bones a trial of drilling has had in a resumed file.
  std::int32_t bones_used(const protocols::PlannedTrial& trial) const;
  /// Whether an earlier run ended during the trial without time to write what it held.
  bool was_cut_short(const protocols::PlannedTrial& trial) const;
  /// Of a trial in a resumed file; 0 where it has none.
  int attempts(const protocols::PlannedTrial& trial) const;
  /// Once a block, also over several runs.
  void keep_stimulus(const protocols::PlannedTrial& trial, const stimulus::Stimulus& stimulus);

  /// @returns the number of its row, for its samples.
  std::int32_t begin_pass(const protocols::PlannedTrial& trial, record::Phase phase, int attempt);
  /// The present pass, or the last one.
  const record::PassRow& pass() const { return row_; }
  void end_pass(const protocols::PassResult& result);

  /// What the servo thread has recorded since the last call, shown to `follow`.
  /// @returns the number of records.
  using Follower = std::function<void(std::span<const record::Sample>)>;
  std::size_t collect(const Follower& follow);
  /// @param frames  with times since this run's first tick
  void keep_frames(std::vector<record::FrameRow> frames);
  void event(const std::string& kind, const std::string& text);
  /// On the stream only: what the file's tables say already. @param status  empty: none yet
  void mark_trial(const std::string& kind, const protocols::PlannedTrial& trial, int attempt,
                  const std::string& status = "");

  /// @param trials  of the study that this run is to present. Call before open().
  void set_planned(std::ptrdiff_t trials) {
    writer_.set_planned(static_cast<std::int32_t>(trials));
  }
  /// After the loop's end, where trials are left for another run: FILE.partial stays.
  void stop(const std::string& text);
  /// After the loop's end: the last event and the timing; the file is complete.
  void close(const std::string& text);
  /// After the loop's end, where the session did not come to its own: a simulated one leaves
  /// nothing, another FILE.partial, with its open pass as aborted.
  void give_up(const protocols::SessionTask& task);

 private:
  std::int64_t now_ns() const;
  void mark(const std::string& text);
  void keep_definition();
  bool was_skipped(const protocols::PlannedTrial& trial) const;
  bool goes_on(std::int32_t row) const;
  void append(std::span<const record::Sample> samples);
  void append_rest();
  void append_drilling();
  void add_pass(record::PassStatus status, std::uint64_t first_sample, std::uint64_t last_sample);
  void tell_what_was_kept();
  record::TimingSummary counts() const;
  void write_timing(record::RunState state);

  const SessionRequest& request_;
  const realtime::ServoLoop& loop_;
  const bool real_;
  record::Resumed before_;  // what a resumed file holds
  // Before the writer: without the streams that it needs a session leaves no file.
  std::string notice_;
  std::unique_ptr<stream::LslOutlet> outlet_;
  StreamMarkers markers_;
  record::SessionWriter writer_;
  protocols::SessionTask::Log log_;
  struct Drilling {
    protocols::SessionTask::ToolLog tool;
    protocols::DrillingLogs logs;
  };
  std::unique_ptr<Drilling> drilling_;
  LiveDrilling* live_;
  std::vector<std::int32_t> blocks_;  // whose stimuli are in the file
  record::PassRow row_;
  record::PassRow last_;      // the pass before, of an earlier run too
  std::int64_t start_ns_{0};  // of this run
  bool row_open_{false};      // and is not in the file yet
  std::int32_t passes_{0};
  std::chrono::steady_clock::time_point flushed_{};
};

}  // namespace haptrial::experiments
