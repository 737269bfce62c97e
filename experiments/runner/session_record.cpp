#include "experiments/runner/session_record.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/record/read/definition_versions.h"
#include "core/record/rows/trial_facts.h"
#include "experiments/plan/plan_log.h"
#include "experiments/runner/earlier_run.h"
#include "experiments/runner/session_opening.h"

namespace haptrial::experiments {

using protocols::PlannedTrial;

namespace {

std::string name_of(const PlannedTrial& trial) {
  return fmt::format("trial={} practice={} condition={}", trial.trial, trial.practice ? 1 : 0,
                     trial.condition);
}

record::PassRow row_of(const PlannedTrial& trial, const record::Phase& phase, int attempt) {
  record::PassRow row;
  row.trial = trial.trial;
  row.condition = trial.condition;
  row.phase = phase;
  row.block = trial.block;
  row.repetition = trial.repetition;
  row.stimulus_seed = trial.stimulus_seed;
  row.practice = trial.practice;
  row.attempt = attempt;
  return row;
}

}  // namespace

SessionRecord::SessionRecord(const SessionRequest& request, const device::DeviceInfo& device,
                             const realtime::ServoLoop& loop, protocols::Trials& trials,
                             markers::OnsetLog& onsets, channel::ChannelSet& channels,
                             record::LiveFigures* live)
    : request_(request),
      loop_(loop),
      real_(request.clock == realtime::ClockKind::kReal),
      outlet_(open_outlet(
          request, device.simulated, [this] { return now_ns(); }, notice_)),
      markers_(request, onsets, outlet_.get(), [this] { return now_ns(); }),
      writer_(open_writer(request, device, before_, trials, channels)),
      file_(writer_),
      stream_(outlet_.get(), request.definition->side_streams()),
      sinks_{&file_},
      trials_(trials),
      channels_(channels),
      blocks_(before_.blocks),
      passes_(static_cast<std::int32_t>(before_.passes.size() + before_.open_passes.size())) {
  start_ns_ = last_time(before_) + 1;
  if (live != nullptr) {
    sinks_.push_back(live);
  }
  sinks_.push_back(&stream_);
}

protocols::Origin SessionRecord::origin() const { return {before_.next_sequence, start_ns_}; }

void SessionRecord::open(const std::string& text) {
  for (const record::OpenPass& open : before_.open_passes) {
    row_ = {};
    row_.condition = "unknown";
    const auto begun = std::find_if(before_.begun.begin(), before_.begun.end(),
                                    [&](const auto& each) { return each.row == open.row; });
    if (begun != before_.begun.end()) {
      row_ = begun->pass;
    }
    add_pass(record::PassStatus::kAborted, open.first_sample, open.last_sample);
    before_.passes.push_back(row_);
  }
  if (before_.rows > 0) {
    tell_what_was_kept();
  }
  event(before_.rows > 0 ? record::kSessionResumed : "session_start", text);
  note_plan();
  writer_.note_counts({0, 0, 0});
  keep_definition();
  if (const std::string state = markers_.sound_state(); !state.empty()) {
    event("sound", state);
  }
  if (!before_.passes.empty()) {
    last_ = before_.passes.back();
  }
  if (before_.rows > 0) {
    writer_.sync();  // all of it can be read again from here on
  }
}

/// Keeps which plan the session belongs to, and whether it was begun for its first trials alone.
void SessionRecord::note_plan() {
  std::string text = plan_event(request_.file.parent_path());
  if (text.empty()) {
    return;
  }
  const int trials = trials_.extent(request_.max_trials).trials;
  if (trials < trials_.extent(0).trials) {
    text += fmt::format(" first_trials={}", trials);
  }
  event(kPlanEvent, text);
}

/// Tells whoever started the session again what was kept, before anything else happens.
void SessionRecord::tell_what_was_kept() {
  if (!before_.repaired.empty()) {
    fmt::print(stderr, "{}\n", before_.repaired);
  }
  fmt::print(stderr, "{}: resumed after {} ticks and {} passes\n", request_.file.string(),
             before_.next_sequence, before_.passes.size());
}

/// Keeps the definition if a resumed session has another one than it was last recorded with.
void SessionRecord::keep_definition() {
  if (before_.info.definition.empty()) {
    return;  // the file is new
  }
  record::SessionInfo last = before_.info;
  last.definition = record::newest_definition(before_.info, before_.events);
  const DefinitionChanges changes = changes_since(request_, last);
  if (changes.same_text) {
    return;
  }
  event(record::kDefinitionChanged,
        changes.free.empty() ? "only comments or layout" : sentence_of(changes.free));
  writer_.add_event({now_ns(), record::kNewDefinition, request_.definition->text});
}

bool SessionRecord::was_cut_short(const PlannedTrial& trial) const {
  return cut_short(before_, trial);
}

std::uint64_t SessionRecord::dropped() const {
  return log_.dropped() + device_log_.dropped() + trials_.dropped() + markers_.dropped();
}

void SessionRecord::note_damping(double least, double seconds) {
  const record::DampingRow row{now_ns(), row_.trial, least, seconds};
  put(record::Rows(std::span(&row, 1)));
  event("damping_reduced",
        fmt::format("trial {}: damping fell to {:.3f} of the definition's, and was reduced for "
                    "{:.3f} s of the run",
                    row_.trial, least, seconds));
}

void SessionRecord::skip(const PlannedTrial& trial) {
  const record::SkippedRow row{now_ns(), trial.trial, trial.practice};
  put(record::Rows(std::span(&row, 1)));
  event("skipped", name_of(trial));
  if (real_) {
    writer_.flush();
  }
}

void SessionRecord::take_back(std::int32_t trial, std::span<const std::int32_t> passes) {
  for (const std::int32_t pass : passes) {
    const record::TakenBackRow row{now_ns(), trial, pass};
    put(record::Rows(std::span(&row, 1)));
  }
  if (real_) {
    writer_.flush();
  }
}

bool SessionRecord::holds_stimulus(std::int32_t block) const {
  return std::find(blocks_.begin(), blocks_.end(), block) != blocks_.end();
}

void SessionRecord::keep_stimulus(std::int32_t block, std::span<const record::StimulusRow> rows) {
  if (!holds_stimulus(block)) {
    writer_.add_stimulus(rows);
    blocks_.push_back(block);
  }
}

void SessionRecord::keep_responses(std::vector<record::ResponseRow> rows) {
  for (record::ResponseRow& row : rows) {
    row.trial = row_.trial;
    row.pass = passes_ - 1;
    row.time_ns = time_of(row.sequence);
  }
  put(record::Rows(std::span<const record::ResponseRow>(rows)));
}

void SessionRecord::keep_answer(record::AnswerRow row) {
  row.time_ns = now_ns();
  put(record::Rows(std::span<const record::AnswerRow>(&row, 1)));
  if (real_) {
    writer_.sync_soon();  // nobody is to be asked twice
  }
}

std::int32_t SessionRecord::begin_pass(const PlannedTrial& trial, const record::Phase& phase,
                                       int attempt) {
  row_ = row_of(trial, phase, attempt);
  row_open_ = true;
  times_.clear();
  markers_.begin_pass(passes_, row_.trial);
  writer_.begin_pass({passes_, row_});
  for (record::Sink* sink : sinks_) {
    sink->begin_pass(row_, passes_);
  }
  return passes_++;
}

void SessionRecord::end_pass(const protocols::PassResult& result) {
  append_rest();
  keep_markers(false);
  const bool aborted = result.state == protocols::PassState::kAborted || markers_.lost_stimuli();
  add_pass(aborted ? record::PassStatus::kAborted : record::PassStatus::kCompleted,
           result.first_sample, result.last_sample);
}

void SessionRecord::add_pass(record::PassStatus status, std::uint64_t first_sample,
                             std::uint64_t last_sample) {
  row_.status = status;
  row_.first_sample = first_sample;
  row_.last_sample = last_sample;
  for (record::Sink* sink : sinks_) {
    sink->end_pass(row_);
  }
  last_ = row_;
  row_open_ = false;
  if (real_) {
    writer_.sync_soon();
  }
}

std::size_t SessionRecord::collect(const Follower& follow) {
  const auto take = [&](std::span<const record::Sample> samples) {
    append(samples);
    follow(samples);
  };
  const std::size_t count = real_ ? log_.flush(take) : log_.drain(take);
  keep_channels();
  if (!real_) {
    trials_.empty_logs(*this);  // it may wait for that, and the next full block is a second away
  }
  constexpr std::chrono::milliseconds kFlushEvery{500};
  const auto now = std::chrono::steady_clock::now();
  if (real_ && now - flushed_ >= kFlushEvery) {
    flushed_ = now;
    writer_.note_counts(counts());
    writer_.flush();
    tell_notices();
  }
  return count;
}

/// Says what befell the file.
void SessionRecord::tell_notices() {
  for (const std::string& notice : writer_.take_notices()) {
    fmt::print(stderr, "{}\n", notice);
    if (writer_.can_go_on()) {
      event("notice", notice);
    }
  }
}

void SessionRecord::append(std::span<const record::Sample> samples) {
  // The logs hold at least the records of these ticks: a tick's own record is pushed after the
  // protocol's.
  trials_.empty_logs(*this);
  device_log_.flush([this](std::span<const record::DeviceRow> rows) { put(record::Rows(rows)); });
  for (const record::Sample& sample : samples) {
    if (sample.pass >= 0) {
      times_.push_back(sample.time_ns);
      first_time_ = times_.size() == 1 ? sample.sequence : first_time_;
    }
  }
  for (record::Sink* sink : sinks_) {
    sink->samples(samples);
  }
}

void SessionRecord::put(const record::Rows& batch) {
  for (record::Sink* sink : sinks_) {
    sink->rows(batch);
  }
}

/// Keeps the markers before the row of their pass: a finished trial has its markers, whatever
/// follows.
void SessionRecord::keep_markers(bool last) {
  const std::vector<record::MarkerRow> rows = markers_.take_rows(last);
  if (!rows.empty()) {
    put(record::Rows(std::span<const record::MarkerRow>(rows)));
  }
  if (!last || !markers_.used()) {
    return;
  }
  for (const std::string& line : markers_.latencies()) {
    event("markers", line);
  }
}

void SessionRecord::append_rest() {
  log_.flush([this](std::span<const record::Sample> samples) { append(samples); });
  keep_channels();
}

void SessionRecord::keep_channels() {
  channels_.collect(now_ns(), [this](const record::Rows& rows) { put(rows); });
}

void SessionRecord::event(const std::string& kind, const std::string& text) {
  event_at(now_ns(), kind, text);
}

void SessionRecord::event_at(std::int64_t time_ns, const std::string& kind,
                             const std::string& text) {
  const record::EventRow row{time_ns, kind, text};
  for (record::Sink* sink : sinks_) {
    sink->event(row);
  }
}

void SessionRecord::mark(const std::string& text) {
  if (outlet_) {
    outlet_->mark(text, now_ns());
  }
}

void SessionRecord::mark_trial(const std::string& kind, const PlannedTrial& trial, int attempt,
                               const std::string& status) {
  const std::string fields = marker_fields(row_of(trial, record::Phase::kTraining, attempt));
  mark(fmt::format("{}: {}{}", kind, status.empty() ? "" : "status=" + status + " ", fields));
}

void SessionRecord::stop(const std::string& text) {
  append_rest();
  keep_markers(true);
  event("session_stopped", text);
  write_timing(record::RunState::kStopped);
  writer_.sync();
}

void SessionRecord::keep_frames(std::vector<record::FrameRow> frames) {
  for (record::FrameRow& frame : frames) {
    frame.time_ns += start_ns_;
  }
  writer_.add_frames(frames);
}

/// Time of a tick of the present pass; now, if it has none.
std::int64_t SessionRecord::time_of(std::uint64_t sequence) const {
  const std::uint64_t at = sequence - first_time_;
  return sequence >= first_time_ && at < times_.size() ? times_[at] : now_ns();
}

std::int64_t SessionRecord::now_ns() const { return start_ns_ + loop_.elapsed_ns(); }

void SessionRecord::close(const std::string& text) {
  append_rest();
  keep_markers(true);
  event("session_end", text);
  write_timing(record::RunState::kEnded);
  writer_.close();
  tell_notices();
}

void SessionRecord::give_up(const protocols::SessionTask& task) {
  const bool nothing = loop_.ticks() == 0 && before_.rows == 0;
  if (!real_ || nothing) {
    writer_.discard();  // a dry run can be repeated; half of one is of no use
    return;
  }
  append_rest();
  keep_markers(true);
  const protocols::PassResult& result = task.result();
  if (row_open_ && result.begun) {
    add_pass(record::PassStatus::kAborted, result.first_sample,
             task.idle() ? result.last_sample : origin().sequence + loop_.ticks() - 1);
  }
  event("interrupted", "the session was interrupted before its end");
  write_timing(record::RunState::kStopped);
  writer_.sync();
}

record::TimingSummary SessionRecord::counts() const {
  return {loop_.ticks(), loop_.overruns(), dropped()};
}

void SessionRecord::write_timing(record::RunState state) {
  const realtime::LoopTiming& timing = loop_.timing();
  std::vector<record::TimingRow> rows;
  for (std::size_t i = 0; i < realtime::DurationHistogram::kBins; ++i) {
    const auto period = timing.period.bin(i);
    const auto lateness = timing.lateness.bin(i);
    const auto compute = timing.compute.bin(i);
    if (period.count + lateness.count + compute.count > 0) {
      rows.push_back({period.low, period.high, period.count, lateness.count, compute.count});
    }
  }
  writer_.set_timing(rows, counts(), state);
}

}  // namespace haptrial::experiments
