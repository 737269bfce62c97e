#include "core/record/read/session_facts.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>
#include <iterator>
#include <set>
#include <string_view>
#include <utility>

#include "core/base/error.h"

namespace haptrial::record {

void check_phases(const SessionReader& file, std::span<const Phase> known) {
  for (const PassRow& pass : file.passes()) {
    if (std::find(known.begin(), known.end(), pass.phase) == known.end()) {
      std::vector<std::string> names;
      for (const Phase& phase : known) {
        names.emplace_back(phase.name());
      }
      throw InputError(
          fmt::format("{}: the column phase of /trials has the unknown word '{}'; allowed: {}",
                      file.path().string(), pass.phase.name(), fmt::join(names, ", ")));
    }
  }
}

std::string imported_from(const SessionReader& reader) {
  for (const EventRow& event : reader.events()) {
    if (event.kind == kImportedEvent) {
      return event.text;
    }
  }
  return "";
}

std::optional<std::string> too_many_overruns(std::uint64_t ticks, std::uint64_t overruns) {
  constexpr double kMost = 0.01;
  if (static_cast<double>(overruns) <= kMost * static_cast<double>(ticks)) {
    return std::nullopt;
  }
  return fmt::format("{} of {} ticks ({:.1f} %) overran their period", overruns, ticks,
                     100.0 * static_cast<double>(overruns) / static_cast<double>(ticks));
}

TrialProgress trial_progress(const SessionReader& reader) {
  TrialProgress progress;
  for (const RunRow& run : reader.runs()) {
    if (run.planned >= 0) {
      progress.planned = run.planned;
    }
  }
  for (const EventRow& event : reader.events()) {
    if (event.kind == kEndedForGood || event.kind == kGivenUp) {
      progress.ended_early = event.text;
    }
  }
  std::set<int> begun, done, skipped;
  for (const PassRow& pass : reader.passes()) {
    if (pass.practice || pass.trial < 1) {
      continue;
    }
    begun.insert(pass.trial);
    // A training pass is followed by the test pass of its trial.
    if (pass.phase != Phase::kTraining && pass.status == PassStatus::kCompleted) {
      done.insert(pass.trial);
    }
  }
  for (const SkippedRow& row : skipped_trials(reader)) {
    if (!row.practice && !done.contains(row.trial)) {
      skipped.insert(row.trial);
    }
  }
  const auto is_done = [&](int trial) { return done.contains(trial); };
  const auto left = static_cast<int>(begun.size()) -
                    static_cast<int>(std::count_if(begun.begin(), begun.end(), is_done));
  progress.done = static_cast<int>(done.size());
  progress.skipped = static_cast<int>(skipped.size());
  progress.aborted = std::max(left - progress.skipped, 0);
  return progress;
}

namespace {

/// All the numbers in a text.
std::vector<double> numbers_in(std::string_view text) {
  std::vector<double> numbers;
  for (std::size_t at = 0; (at = text.find_first_of("0123456789", at)) != text.npos;) {
    double value = 0.0;
    const auto [end, error] = std::from_chars(text.data() + at, text.data() + text.size(), value);
    if (error != std::errc{}) {
      return {};
    }
    numbers.push_back(value);
    at = static_cast<std::size_t>(end - text.data());
  }
  return numbers;
}

/// "trial=3 practice=0 condition=haptic"
std::vector<SkippedRow> skipped_in(const std::vector<EventRow>& events) {
  std::vector<SkippedRow> rows;
  for (const EventRow& event : events) {
    const std::vector<double> numbers =
        event.kind == "skipped" ? numbers_in(event.text) : std::vector<double>();
    if (numbers.size() >= 2) {
      rows.push_back({event.time_ns, static_cast<std::int32_t>(numbers[0]), numbers[1] != 0.0});
    }
  }
  return rows;
}

/// "trial 3: damping fell to 0.052 of the definition's, and was reduced for 1.250 s of the run"
std::vector<DampingRow> damping_in(const std::vector<EventRow>& events) {
  std::vector<DampingRow> rows;
  for (const EventRow& event : events) {
    const std::vector<double> numbers =
        event.kind == "damping_reduced" ? numbers_in(event.text) : std::vector<double>();
    if (numbers.size() == 3) {
      rows.push_back(
          {event.time_ns, static_cast<std::int32_t>(numbers[0]), numbers[1], numbers[2]});
    }
  }
  return rows;
}

}  // namespace

bool is_mirrored(const SessionReader& reader) {
  return std::ranges::any_of(reader.events(),
                             [](const EventRow& event) { return event.kind == kMirroredEvent; });
}

std::string case_in(const std::vector<EventRow>& events) {
  const auto at = std::ranges::find(events, kCaseEvent, &EventRow::kind);
  return at != events.end() ? at->text : "";
}

std::vector<SkippedRow> skipped_trials(const SessionReader& reader) {
  std::vector<SkippedRow> rows =
      reader.has(table_of<SkippedRow>()) ? reader.rows<SkippedRow>() : skipped_in(reader.events());
  std::vector<SkippedRow> once;
  for (const SkippedRow& row : rows) {
    if (std::ranges::none_of(once, [&](const SkippedRow& other) {
          return other.trial == row.trial && other.practice == row.practice;
        })) {
      once.push_back(row);
    }
  }
  return once;
}

std::vector<DampingRow> reduced_damping(const SessionReader& reader) {
  return reader.has(table_of<DampingRow>()) ? reader.rows<DampingRow>()
                                            : damping_in(reader.events());
}

}  // namespace haptrial::record
