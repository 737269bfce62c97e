#include "experiments/study/session_times.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/base/counted.h"
#include "core/record/read/session_reader.h"
#include "experiments/study/roster.h"
#include "experiments/study/study_files.h"
#include "protocols/definition/definition.h"

namespace haptrial::experiments {
namespace {

namespace fs = std::filesystem;

/// A simulated clock stands still in breaks.
double seconds_of(const record::SessionReader& session, const protocols::Definition& d) {
  const double recorded = static_cast<double>(session.sample_count()) / session.info().rate;
  if (session.info().clock != "real") {
    const auto breaks = std::ranges::count(session.events(), "break", &record::EventRow::kind);
    return recorded + static_cast<double>(breaks) * d.design.break_duration;
  }
  double last = recorded;
  for (const record::EventRow& event : session.events()) {
    last = std::max(last, 1e-9 * static_cast<double>(event.time_ns));
  }
  return last;
}

bool was_ended(const record::SessionReader& session) {
  const auto events = session.events();
  return std::ranges::find(events, record::kEndedForGood, &record::EventRow::kind) != events.end();
}

}  // namespace

std::optional<SessionTimes> session_times(const std::vector<std::filesystem::path>& files,
                                          const protocols::Definition& definition) {
  SessionTimes times;
  for (const std::filesystem::path& file : distinct_sessions(files).files) {
    const record::SessionReader session(file);
    if (session.info().pilot || is_declined(session) || was_ended(session)) {
      continue;
    }
    const double seconds = seconds_of(session, definition);
    times.shortest = times.sessions == 0 ? seconds : std::min(times.shortest, seconds);
    times.longest = std::max(times.longest, seconds);
    times.mean += (seconds - times.mean) / ++times.sessions;
  }
  return times.sessions > 0 ? std::optional(times) : std::nullopt;
}

std::optional<SessionTimes> recorded_times(const fs::path& folder,
                                           const protocols::Definition& definition) {
  std::vector<fs::path> files;
  std::error_code ignored;
  for (const auto& entry : fs::directory_iterator(folder, ignored)) {
    if (entry.path().extension() == ".h5") {
      files.push_back(entry.path());
    }
  }
  return session_times(files, definition);
}

static std::string minutes_text(double seconds) {
  constexpr double kMinute = 60.0;
  constexpr double kFew = 10.0;
  const double all = seconds / kMinute;
  return all < kFew ? fmt::format("{:.1f}", all) : fmt::format("{:.0f}", all);
}

std::string time_words(const SessionTimes& times) {
  return fmt::format("{} minutes ({} to {} in {})", minutes_text(times.mean),
                     minutes_text(times.shortest), minutes_text(times.longest),
                     counted(times.sessions, "session", "sessions"));
}

namespace {

std::string long_time_text(double seconds) {
  constexpr double kHour = 3600.0;
  return seconds < kHour ? minutes_text(seconds) + " minutes"
                         : fmt::format("{:.1f} hours", seconds / kHour);
}

}  // namespace

std::string lab_time(const SessionTimes& times, int sessions, std::optional<double> setup) {
  constexpr double kMinute = 60.0;
  std::string text = fmt::format("a session takes {}; {} {}", time_words(times),
                                 counted(sessions, "session takes", "sessions take"),
                                 long_time_text(sessions * times.mean));
  if (setup) {
    text += fmt::format(", {} in the lab with {:g} minutes between them",
                        long_time_text(sessions * (times.mean + *setup * kMinute)), *setup);
  }
  return text;
}

double session_seconds(const protocols::Definition& d, int trials) {
  const int breaks = d.design.break_after > 0 ? (trials - 1) / d.design.break_after : 0;
  return d.longest(trials) + breaks * d.design.break_duration;
}

/// How many sessions the participants of a group come to.
static int sessions_of(const Roster& roster, const std::string& group) {
  const auto at = std::ranges::find(roster.groups, group, &RosterGroup::name);
  return at != roster.groups.end() ? at->sessions : roster.sessions;
}

int sessions_to_come(const Roster& roster) {
  int planned = 0;
  for (const RosterGroup& group : roster.groups) {
    planned += group.planned * group.sessions;
  }
  int had = 0;
  for (const RosterPerson& person : roster.persons) {
    if (person.pilot || person.excluded || person.never_took_part()) {
      continue;
    }
    if (person.declined() || person.next == 0) {
      had += sessions_of(roster, person.group);  // nothing more is to be run
      continue;
    }
    had += static_cast<int>(std::ranges::count_if(person.sessions, [](const RosterSession& each) {
      return each.state == SessionState::kDone || each.state == SessionState::kAborted;
    }));
  }
  return std::max(0, planned - had);
}

}  // namespace haptrial::experiments
