#include "core/record/rows/session_tables.h"

#include <algorithm>
#include <string>
#include <string_view>
#include <utility>

#include "core/record/table/schema.h"

namespace haptrial::record {

std::vector<EventPart> event_parts(const EventRow& event) {
  std::vector<EventPart> parts;
  std::string_view rest = event.text;
  check_text(event.kind, kKindBytes, "event kind");  // before the first part is put anywhere
  check_text(rest, rest.size(), "event text");
  do {
    std::size_t size = std::min(rest.size(), kTextBytes);
    // A cut never falls within a UTF-8 character (at most three continuation bytes back).
    if (size < rest.size()) {
      std::size_t cut = size;
      while (cut + 4 > size && (static_cast<unsigned char>(rest[cut]) & 0xC0u) == 0x80u) {
        --cut;
      }
      if ((static_cast<unsigned char>(rest[cut]) & 0xC0u) != 0x80u) {
        size = cut;
      }
    }
    parts.push_back({{event.time_ns, event.kind, std::string(rest.substr(0, size))},
                     static_cast<std::int32_t>(parts.size())});
    rest.remove_prefix(size);
  } while (!rest.empty());
  return parts;
}

std::vector<EventRow> joined_events(std::vector<EventPart> parts) {
  std::vector<EventRow> events;
  for (EventPart& part : parts) {
    if (part.part > 0 && !events.empty()) {
      events.back().text += part.row.text;
    } else {
      events.push_back(std::move(part.row));
    }
  }
  return events;
}

namespace {

using Names3 = std::array<const char*, 3>;
constexpr Names3 kPosition{"position_x", "position_y", "position_z"};

template <class E>
EnumText::Entry entry(E value, const char* word) {
  return {static_cast<std::uint8_t>(value), word};
}
template <class E>
EnumText::Entry entry(E value) {
  return entry(value, name_of(value));
}

EnumText stages() {
  return EnumText({entry(Stage::kIdle, "idle"), entry(Stage::kApproach, "approach"),
                   entry(Stage::kWait, "wait"), entry(Stage::kRun, "run"),
                   entry(Stage::kReturn, "return")});
}

EnumText statuses() {
  return EnumText(
      {entry(PassStatus::kCompleted), entry(PassStatus::kAborted), entry(PassStatus::kDamaged)});
}

EnumText states() {
  return EnumText({entry(RunState::kRunning), entry(RunState::kStopped), entry(RunState::kEnded)});
}

}  // namespace

const Table<Sample>& samples_table() {
  using R = Sample;
  using T = Table<R>;
  static const T table(
      {"samples",
       "one row for each tick of the servo loop",
       kLongestChunk,
       RowsOf::kEachTick,
       {"sequence"}},
      {T::column("sequence", &R::sequence, "1", "tick number from 0; a gap is a loss"),
       T::column("time_ns", &R::time_ns, "ns", "since the first tick of the session"),
       T::column("pass", &R::pass, "1", "row of /trials; -1 between passes"),
       T::code("stage", &R::stage, stages(), "0 idle, 1 approach, 2 wait, 3 run, 4 return"),
       T::rounded_elements(kPosition, &R::position, "m", "tool tip in the world frame",
                           kPositionResolution),
       T::rounded_elements(Names3{"velocity_x", "velocity_y", "velocity_z"}, &R::velocity, "m/s",
                           "tool tip in the world frame", kVelocityResolution),
       T::rounded_elements(Names3{"force_x", "force_y", "force_z"}, &R::force, "N",
                           "commanded to the device, in the world frame", kForceResolution),
       T::rounded("applied_force", &R::applied_force, "N",
                  "normal force of the participant, downward positive", kForceResolution),
       T::rounded("target_force", &R::target_force, "N", "normal force to apply", kForceResolution),
       T::column("saturated", &R::saturated, "1", "1 where the force limit was reached")});
  return table;
}

const Table<FrameRow>& frames_table() {
  using R = FrameRow;
  using T = Table<R>;
  static const T table(
      {"frames",
       "one row for each frame of the participant's screen",
       48,  // 0.8 s at 60 Hz
       RowsOf::kSession,
       {"time_ns"},
       "",
       2},
      {T::column("time_ns", &R::time_ns, "ns",
                 "when the frame was shown, since the first tick of the session"),
       T::column("frame_time_ns", &R::frame_time_ns, "ns", "what drawing the frame took"),
       T::column("dropped", &R::dropped, "1",
                 "refreshes of the screen missed since the frame before")});
  return table;
}

const Table<PassRow>& trials_table() {
  using R = PassRow;
  using T = Table<R>;
  static const T table(
      {"trials", "one row for each pass", 64, RowsOf::kSession, {"first_sample"}},
      {T::column("trial", &R::trial, "1",
                 "trial number from 1; a training pass and a test pass, or a drilling"),
       T::text("condition", &R::condition, kConditionBytes, "training condition of the block"),
       T::name("phase", &R::phase, "what the pass is for: a word of the protocol"),
       T::column("block", &R::block, "1",
                 "block number from 1; of practice -1, -2, ..., 0 in files of older versions"),
       T::column("repetition", &R::repetition, "1",
                 "number from 1 within the block; of a drilling the number of its bone"),
       T::column("stimulus_seed", &R::stimulus_seed, "1", "seed of the block's stimulus"),
       T::column("first_sample", &R::first_sample, "1",
                 "sequence number of the first sample, inclusive"),
       T::column("last_sample", &R::last_sample, "1",
                 "sequence number of the last sample, inclusive"),
       T::word(
           "status", &R::status, kStatusBytes, statuses(),
           "completed, aborted, or damaged: completed, but samples of it were lost with the file"),
       T::since(2, T::column("practice", &R::practice, "1",
                             "1 where the pass is not part of the study")),
       T::since(
           2, T::column("attempt", &R::attempt, "1",
                        "number from 1; above 1 the trial was aborted before and queued again"))});
  return table;
}

const Table<EventPart>& events_table() {
  using R = EventPart;
  using T = Table<R>;
  static const T table(
      {"events", "what happened when", 64, RowsOf::kSession, {"time_ns", "part"}},
      {T::column(
           "time_ns", [](R & r) -> auto& { return r.row.time_ns; }, "ns",
           "since the first tick of the session"),
       T::text(
           "kind", [](R & r) -> auto& { return r.row.kind; }, kKindBytes,
           "what happened, in one word"),
       T::text(
           "text", [](R & r) -> auto& { return r.row.text; }, kTextBytes, "details"),
       T::column("part", &R::part, "1",
                 "0; 1, 2, ... where the row continues the text of the row before")});
  return table;
}

const Table<StimulusRow>& stimuli_table() {
  using R = StimulusRow;
  using T = Table<R>;
  static const T table(
      {"stimuli", "the ideal movement and force of each block", 4096, RowsOf::kSession, {"block"}},
      {T::column("block", &R::block, "1", "block number from 1"),
       T::column("time", &R::time, "s", "since the start of the run"),
       T::elements(kPosition, &R::position, "m", "ideal tool tip in the world frame"),
       T::column("force", &R::force, "N", "target normal force")});
  return table;
}

const Table<TimingRow>& timing_table() {
  using R = TimingRow;
  using T = Table<R>;
  static const T table(
      {"timing", "histogram of how the loop kept time", 256, RowsOf::kSession, {"bin_low_ns"}},
      {T::column("bin_low_ns", &R::bin_low_ns, "ns", "lower edge of the bin, inclusive"),
       T::column("bin_high_ns", &R::bin_high_ns, "ns", "upper edge of the bin, exclusive"),
       T::column("period_count", &R::period_count, "1",
                 "ticks whose time since the tick before lies in the bin"),
       T::column("lateness_count", &R::lateness_count, "1",
                 "ticks whose start lagged the schedule by a time in the bin"),
       T::column("compute_count", &R::compute_count, "1",
                 "ticks whose computation took a time in the bin")});
  return table;
}

const Table<EventPart>& attributes_table() {
  using R = EventPart;
  using T = Table<R>;
  static const T table(
      {"attributes",
       "the root attributes once more: found even where the file's structure is lost",
       512,
       RowsOf::kSession,
       {"part"},
       "",
       2},
      {T::text(
           "name", [](R & r) -> auto& { return r.row.kind; }, kKindBytes,
           "of a root attribute, or of a count of /timing"),
       T::text(
           "value", [](R & r) -> auto& { return r.row.text; }, kTextBytes, "as text"),
       T::column("part", &R::part, "1",
                 "0; 1, 2, ... where the row continues the value of the row before")});
  return table;
}

const Table<RunRow>& runs_table() {
  using R = RunRow;
  using T = Table<R>;
  static const T table(
      {"runs",
       "what the loop of each run of the session counted: its last row counts",
       16,
       RowsOf::kSession,
       {"run"},
       "",
       4},
      {T::column("run", &R::run, "1", "number from 1: from one start of the program to its end"),
       T::column("first_sample", &R::first_sample, "1",
                 "sequence number of the first tick of the run"),
       T::column(
           "ticks", [](R & r) -> auto& { return r.counts.ticks; }, "1", "ticks of the run so far"),
       T::column(
           "overruns", [](R & r) -> auto& { return r.counts.overruns; }, "1",
           "ticks of the run so far that began after their period had passed"),
       T::column(
           "dropped", [](R & r) -> auto& { return r.counts.dropped; }, "1",
           "records of the run so far that were lost on the way"),
       T::column("planned", &R::planned, "1", "trials of the study; -1: not known"),
       T::word("state", &R::state, kStatusBytes, states(),
               "running, stopped (the session goes on in another run) or ended")});
  return table;
}

const Table<BegunRow>& begun_table() {
  using R = BegunRow;
  using T = Table<R>;
  static const T table(
      {"begun",
       "one row for each pass, written when it begins",
       64,
       RowsOf::kSession,
       {"pass"},
       "",
       4},
      {T::column("pass", &R::row, "1", "row of /trials that the pass gets"),
       T::column(
           "trial", [](R & r) -> auto& { return r.pass.trial; }, "1",
           "as in /trials, like all that follow"),
       T::text(
           "condition", [](R & r) -> auto& { return r.pass.condition; }, kConditionBytes,
           "training condition of the block"),
       T::name(
           "phase", [](R & r) -> auto& { return r.pass.phase; },
           "what the pass is for: a word of the protocol"),
       T::column(
           "block", [](R & r) -> auto& { return r.pass.block; }, "1", "block number from 1"),
       T::column(
           "repetition", [](R & r) -> auto& { return r.pass.repetition; }, "1",
           "number from 1 within the block; of a drilling the number of its bone"),
       T::column(
           "stimulus_seed", [](R & r) -> auto& { return r.pass.stimulus_seed; }, "1",
           "seed of the block's stimulus"),
       T::column(
           "practice", [](R & r) -> auto& { return r.pass.practice; }, "1",
           "1 where the pass is not part of the study"),
       T::column(
           "attempt", [](R & r) -> auto& { return r.pass.attempt; }, "1",
           "number from 1; above 1 the trial was aborted before and queued again")},
      [](R& row, std::int64_t) { row.pass.status = PassStatus::kAborted; });
  return table;
}

const TableList& session_tables() {
  static const TableList tables{&samples_table(),    &frames_table(),  &trials_table(),
                                &events_table(),     &stimuli_table(), &timing_table(),
                                &attributes_table(), &runs_table(),    &begun_table()};
  return tables;
}

}  // namespace haptrial::record
