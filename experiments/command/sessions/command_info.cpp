#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <string_view>
#include <utility>
#include <vector>

#include "analysis/quality/channel_quality.h"
#include "analysis/quality/timing.h"
#include "core/base/counted.h"
#include "core/record/hdf5/file_lock.h"
#include "core/record/read/integrity.h"
#include "core/record/read/readable.h"
#include "core/record/read/session_facts.h"
#include "core/record/read/session_reader.h"
#include "core/stream/marker_times.h"
#include "experiments/command/subcommand.h"
#include "experiments/studies/registry.h"
#include "protocols/definition/lab_file.h"

namespace haptrial::experiments {
namespace {

/// A text that somebody wrote, within the one line that tells of it: with its line ends it could
/// look like further lines.
std::string in_one_line(std::string text) {
  const auto is_control = [](unsigned char c) { return c < ' ' || c == 0x7f; };
  std::ranges::replace_if(text, is_control, ' ');
  return text;
}

void print_participant(const record::Participant& participant) {
  const std::array<std::pair<const char*, const std::string*>, 5> fields{
      {{"handedness", &participant.handedness},
       {"age", &participant.age_band},
       {"sex", &participant.sex},
       {"consent", &participant.consent_confirmed},
       {"notes", &participant.notes}}};
  for (const auto& [name, value] : fields) {
    if (!value->empty()) {
      fmt::print("{:<11} {}\n", name, in_one_line(*value));
    }
  }
}

void print_loop(const record::SessionReader& reader) {
  const analysis::LoopTiming loop = analysis::loop_timing(reader);
  if (!loop.complete) {
    fmt::print("loop        unknown: the session is unfinished\n");
    return;
  }
  fmt::print("loop        {}, {}\n", counted(loop.overruns, "overrun", "overruns"),
             counted(loop.dropped, "lost record", "lost records"));
  if (const auto late = record::too_many_overruns(loop.ticks, loop.overruns)) {
    fmt::print("loop        NOT kept: {}\n", *late);
  }
  if (loop.applies && loop.lateness) {
    const analysis::TimingPercentiles& late = *loop.lateness;
    const auto us = [](std::int64_t ns) { return 1e-3 * static_cast<double>(ns); };
    fmt::print("lateness    median {:.2f}, 99 % {:.2f}, 99.9 % {:.2f}, worst {:.2f} µs\n",
               us(late.median_ns), us(late.p99_ns), us(late.p999_ns), us(late.highest_ns));
  }
}

void print_channels(const record::SessionReader& reader) {
  for (const analysis::ChannelQuality& c : analysis::channel_quality(reader)) {
    const std::string times =
        c.samples == 0 ? ""
                       : fmt::format(", {:.1f} a second, times within {:.2f} ms (median)", c.rate(),
                                     1e3 * c.uncertainty);
    const std::string texts =
        c.messages == 0 ? "" : fmt::format("{}, ", counted(c.messages, "message", "messages"));
    const std::string faults =
        c.faults == 0 ? "" : fmt::format(", {}", counted(c.faults, "fault", "faults"));
    fmt::print("channel     {}: {}{}{}, {} missing, {}{}, {} of its clock\n", c.name, texts,
               counted(c.samples, "sample", "samples"), times, c.missing,
               counted(c.losses, "loss", "losses"), faults,
               counted(c.clock_steps, "step", "steps"));
  }
}

void print_markers(const record::SessionReader& reader) {
  markers::MarkerLatencies latencies;
  const std::vector<record::MarkerRow> rows = reader.rows<record::MarkerRow>();
  latencies.add(rows);
  for (const markers::MarkerTimes& times : latencies.times()) {
    fmt::print("markers     {}\n", sentence_of(times));
  }
}

void print_frames(const std::vector<record::FrameRow>& frames) {
  if (frames.empty()) {
    return;
  }
  std::int64_t longest = 0;
  std::int64_t dropped = 0;
  for (const record::FrameRow& frame : frames) {
    longest = std::max(longest, frame.frame_time_ns);
    dropped += frame.dropped;
  }
  fmt::print("frames      {} drawn, {} refreshes missed, longest {:.1f} ms\n", frames.size(),
             dropped, 1e-6 * static_cast<double>(longest));
}

void print_progress(const record::SessionReader& reader, const record::Integrity& integrity) {
  const record::TrialProgress trials = record::trial_progress(reader);
  const std::string planned =
      trials.planned ? fmt::format("of {}", *trials.planned) : "of an unknown number";
  fmt::print("trials      {} {} done, {} skipped, {} aborted{}\n", trials.done, planned,
             trials.skipped, trials.aborted,
             integrity.state == record::RunState::kEnded     ? "; the session has ended"
             : integrity.state == record::RunState::kStopped ? "; stopped, resume it with --resume"
                                                             : "; the session is unfinished");
}

/// Whether a kind of event is one that a person did or has to know; the rest is in /events.
bool is_told(const std::string& kind) {
  constexpr std::array<std::string_view, 19> kTold{record::kImportedEvent,
                                                   "plan",
                                                   "consent_declined",
                                                   "consent_by_experimenter",
                                                   "repaired",
                                                   "session_stopped",
                                                   "ended_for_good",
                                                   "aborted",
                                                   "interrupted",
                                                   "notice",
                                                   "note",
                                                   "recovered",
                                                   "overruns",
                                                   "skipped",
                                                   "emergency_stop",
                                                   "definition_changed",
                                                   "bone_restored",
                                                   "bone_lost",
                                                   "bone_anew"};
  return std::find(kTold.begin(), kTold.end(), kind) != kTold.end();
}

int info(const std::string& file) {
  const std::optional<std::string> unreadable = record::what_cannot_be_read(file);
  const record::SessionReader reader(file);
  const record::SessionInfo& i = reader.info();
  record::Integrity integrity = record::check_session(reader, known_tables());
  if (unreadable) {
    integrity.problems.push_back(*unreadable);
    integrity.ok = false;
  }
  fmt::print("subject     {}{}{}{}\n", i.subject,
             i.session > 1 ? fmt::format(", session {}", i.session) : "",
             i.simulated ? " (simulated)" : "", i.pilot ? " (pilot, not part of the study)" : "");
  print_participant(i.participant);
  const std::string lab = protocols::lab_of(i.definition);
  fmt::print("definition  {}{}{}, seed {}\n", i.definition_name, lab.empty() ? "" : " with ", lab,
             i.seed);
  fmt::print("recorded    {}, haptrial {} ({})\n", i.start_utc, i.program_version,
             i.program_commit);
  fmt::print("device      {}, {} N, workspace radius {} m\n", i.device, i.device_max_force,
             i.device_workspace_radius);
  fmt::print("clock       {}, {} Hz\n", i.clock, i.rate);
  fmt::print("rows        {}, sequence {} to {}, {} gaps\n", integrity.rows,
             integrity.first_sequence, integrity.last_sequence, integrity.gaps);
  fmt::print("passes      {}, {} aborted, {}{} for practice\n", integrity.passes, integrity.aborted,
             integrity.damaged > 0 ? fmt::format("{} damaged, ", integrity.damaged) : "",
             integrity.practice);
  print_loop(reader);
  print_frames(reader.frames());
  print_markers(reader);
  print_channels(reader);
  for (const record::EventRow& event : reader.events()) {
    if (is_told(event.kind)) {
      fmt::print("{:<11} at {:.3f} s: {}\n", event.kind, 1e-9 * static_cast<double>(event.time_ns),
                 in_one_line(event.text));
    }
  }
  for (const std::string& problem : integrity.problems) {
    fmt::print("problem     {}\n", in_one_line(problem));
  }
  if (record::FileLock::taken(file)) {
    fmt::print("another haptrial is recording into this file\n");
  }
  print_progress(reader, integrity);
  const bool imported = !record::imported_from(reader).empty();
  fmt::print("recording   {}\n", !integrity.ok ? "NOT intact"
                                 : imported    ? "imported: no ticks were recorded"
                                               : "intact: every tick is recorded");
  return integrity.ok && integrity.state == record::RunState::kEnded ? 0 : 1;
}

}  // namespace

void add_info(CLI::App& app, int& status) {
  CLI::App* sub =
      subcommand(app, "info", "Show what a session file holds and whether it is complete",
                 "haptrial info out/force_training-001/S01.h5", {"", "session-file.md"});
  auto& file = options_of<std::string>(*sub, status, info);
  sub->add_option("FILE", file, "Session file (.h5)")->required();
}

}  // namespace haptrial::experiments
