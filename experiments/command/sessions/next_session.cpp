#include "experiments/command/sessions/next_session.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>

#include "core/base/counted.h"
#include "core/base/definition/table.h"
#include "core/base/error.h"
#include "core/record/hdf5/session_target.h"
#include "core/record/hdf5/session_writer.h"
#include "core/record/read/session_facts.h"
#include "core/record/recovery/session_resume.h"
#include "experiments/command/arguments.h"
#include "experiments/command/sessions/confirmation.h"
#include "experiments/command/sessions/run_checks.h"
#include "experiments/studies/registry.h"
#include "experiments/study/session_name.h"
#include "experiments/study/study_files.h"
#include "protocols/definition/groups.h"

namespace haptrial::experiments {
namespace {

Roster roster_of(const RunOptions& options, const Experiment& experiment) {
  RosterRequest request;
  request.protocol = &experiment.study->protocol();
  request.definition = experiment.definition.get();
  request.definition_file = options.definition;
  request.folder = options.out;
  if (!options.seed.empty()) {
    request.seed = checked_seed(options.seed);
  }
  request.find_case = find_case_of(experiment, options.definition);
  return make_roster(request);
}

/// Somebody new before those who have sessions left; with --resume only who has an unfinished one.
const RosterNext* next_of(const Roster& roster, const RunOptions& options) {
  const auto at = std::find_if(roster.next.begin(), roster.next.end(), [&](const auto& next) {
    return next.resume == options.resume && next.session == options.session.value_or(next.session);
  });
  return at != roster.next.end() ? &*at : nullptr;
}

void choose_case(RunOptions& options, const NextCase& next) {
  options.case_name = options.case_name.empty() ? next.name : options.case_name;
}

/// The case of a session that was named, by the participant's sessions before it.
void choose_case(RunOptions& options, const Experiment& experiment) {
  const Roster roster = roster_of(options, experiment);
  std::vector<std::filesystem::path> files;
  for (const RosterPerson& person : roster.persons) {
    for (const RosterSession& each : person.sessions) {
      if (person.subject == options.subject && person.pilot == options.pilot && !person.excluded &&
          each.state == SessionState::kDone && each.session < options.session.value_or(1)) {
        files.push_back(std::filesystem::path(options.out) / each.file);
      }
    }
  }
  const NextCase next = find_case_of(experiment, options.definition)(files);
  if (next.name.empty()) {
    throw InputError(fmt::format("{}: {} has done every case; add --case for one of them",
                                 options.out, options.subject));
  }
  choose_case(options, next);
}

std::string choose_subject(RunOptions& options, const Experiment& experiment) {
  if (options.pilot) {
    throw InputError(
        "--pilot is given without --subject; the roster names no pilots: add --subject");
  }
  const Roster roster = roster_of(options, experiment);
  const RosterNext* next = next_of(roster, options);
  if (next == nullptr && options.resume) {
    throw InputError(fmt::format("{}: no session is unfinished; leave out --resume", options.out));
  }
  if (next == nullptr) {
    throw InputError(fmt::format(
        "{}: nobody is next: haptrial roster {} {} shows why; add --subject for somebody else",
        options.out, options.definition, options.out));
  }
  options.subject = next->subject;
  options.session = next->session;
  choose_case(options, next->next_case);
  if (!options.participant && next->number > 0) {
    options.participant = next->number;
  }
  return "next: " + words_of(*next, roster.sessions);
}

bool has_cases(const Experiment& experiment) {
  return static_cast<bool>(find_case_of(experiment, ""));
}

/// A pilot is left out of the analysis: not to be given to a participant by mistake.
void confirm_pilot(const RunOptions& options, const Experiment& experiment) {
  const int number = number_of_subject(options.subject);
  const bool of_study = options.subject.starts_with('P') && number > 0 &&
                        number <= experiment.definition->design.participants;
  if (!options.pilot || !of_study) {
    return;
  }
  fmt::print(
      "{} looks like a participant of the study, and --pilot leaves the session out of the "
      "analysis.\n",
      options.subject);
  if (::isatty(STDIN_FILENO) == 0) {
    return;  // nobody can be asked
  }
  if (!confirms("Is it a pilot?")) {
    throw InputError(
        "nothing was recorded: leave out --pilot for a session of the study, or take "
        "another --subject for a pilot, such as T01");
  }
}

/// The first session that the subject has left.
std::string choose_number(RunOptions& options, const Experiment& experiment) {
  const Roster roster = roster_of(options, experiment);
  const auto at =
      std::find_if(roster.persons.begin(), roster.persons.end(), [&](const RosterPerson& person) {
        return person.subject == options.subject && person.pilot == options.pilot &&
               !person.excluded;
      });
  const int session = at != roster.persons.end() ? at->next : 1;
  if (session == 0) {
    throw InputError(
        at->sessions.size() < static_cast<std::size_t>(roster.sessions) && has_cases(experiment)
            ? fmt::format("{}: {} has done every case; add --session and --case for more",
                          options.out, options.subject)
            : fmt::format("{}: {} has had {}", options.out, options.subject,
                          counted(roster.sessions, "session", "sessions")));
  }
  options.session = session;
  return fmt::format("next of {}: session {} of {}", options.subject, session, roster.sessions);
}

}  // namespace

std::optional<double> checked_setup(std::optional<double> minutes) {
  constexpr double kMost = 600.0;
  return minutes ? std::optional(checked_real("--setup", *minutes, 0.0, kMost)) : std::nullopt;
}

int checked_session(int session, const protocols::Definition& setup) {
  return checked_number("--session", session, 1, setup.sessions());
}

std::string words_of(const NextCase& next) {
  return next.name + (next.why.empty() ? "" : fmt::format(" ({})", next.why));
}

std::string words_of(const RosterNext& next, int sessions) {
  std::string words = next.subject;
  words += next.group.empty() ? "" : fmt::format(" (group {})", next.group);
  words += sessions > 1 ? fmt::format(", session {} of {}", next.session, sessions) : "";
  words += next.session_name.empty() ? "" : fmt::format(", {}", next.session_name);
  words += next.resume ? ", to be resumed" : "";
  words += next.blocks.empty() ? "" : fmt::format(": {}", fmt::join(next.blocks, ", "));
  words += next.next_case.name.empty() ? "" : ": case " + words_of(next.next_case);
  return words;
}

namespace {

std::string chosen(RunOptions& options, const Experiment& experiment) {
  if (options.subject.empty()) {
    return choose_subject(options, experiment);
  }
  confirm_pilot(options, experiment);
  return !options.session && experiment.definition->sessions() > 1
             ? choose_number(options, experiment)
             : "";
}

/// The analysis knows a participant's group by the identifier.
void check_number_of_group(const RunOptions& options, const protocols::Definition& d,
                           const std::string& group, bool recorded) {
  const std::string own = protocols::group_of(d.groups, options.subject);
  if (own != group) {
    throw InputError(fmt::format(
        "{} {}, a number of {}, but {} is of {} by its identifier, which the "
        "analysis goes by; allowed: --participant with a number of {}",
        recorded ? "the participant's earlier session has the number" : "--participant is",
        *options.participant, group.empty() ? "no group" : group, options.subject, own, own));
  }
}

/// A session to which the participant's group does not come, or in which a tutor leads and there
/// is none.
/// @param recorded  whether the participant's number is that of an earlier session
void check_place(const RunOptions& options, const protocols::Definition& d, bool recorded) {
  const int session = options.session.value_or(1);
  const int number = options.participant.value_or(number_of_subject(options.subject));
  const std::string group = protocols::group_of(d.groups, number - 1);
  if (options.participant && d.groups.size() > 1 && !options.pilot) {
    check_number_of_group(options, d, group, recorded);
  }
  if (!options.pilot && !d.comes(session, group)) {
    throw InputError(
        fmt::format("{}: session {} is for {}, and {} is of {}; choose another "
                    "--session",
                    options.definition, d.session_name(session),
                    fmt::join(d.session_plan(session).groups, ", "), options.subject,
                    group.empty() ? "no group" : group));
  }
  const bool led = !d.tutoring.led.groups.empty() && d.is_led(session, {1, number - 1, group});
  if (led && !options.pilot && options.tutor.empty() && options.learn_from.empty() &&
      !options.teach) {
    throw InputError(
        fmt::format("{}: a tutor leads {} in session {} (tutoring.led_in); add "
                    "--tutor FILE:TRIAL, or --learn-from",
                    options.definition, options.subject, d.session_name(session)));
  }
}

}  // namespace

/// A session goes on with its own case, whatever would come next by now.
void keep_case(RunOptions& options, const protocols::Definition& d, const std::string& asked) {
  const std::filesystem::path file = session_file(options, d);
  const std::string own =
      record::SessionWriter::can_resume(file)
          ? record::case_in(record::read_unfinished(record::partial_path(file)).events)
          : "";
  if (own.empty()) {
    return;
  }
  if (!asked.empty() && asked != own) {
    throw InputError(
        fmt::format("--case is '{}', but the session that is to be resumed is of the "
                    "case '{}'; leave out --case",
                    asked, own));
  }
  options.case_name = own;
}

std::string choose_session(RunOptions& options, const Experiment& experiment) {
  const protocols::Definition& d = *experiment.definition;
  const std::string asked = options.case_name;
  if (options.session) {
    checked_session(*options.session, d);
  }
  std::string words = chosen(options, experiment);
  const bool recorded = !options.participant;
  if (recorded) {
    options.participant = recorded_number(options, session_file(options, d));
  }
  check_place(options, d, recorded);
  if (options.resume) {
    keep_case(options, d, asked);
  }
  if (options.case_name.empty() && has_cases(experiment)) {
    choose_case(options, experiment);
  }
  words +=
      options.case_name.empty() ? "" : (words.empty() ? "case " : ", case ") + options.case_name;
  return words;
}

std::optional<analysis::SequentialResult> study_standing(const Experiment& experiment,
                                                         const std::filesystem::path& folder,
                                                         int threads) {
  Table root = experiment.definition->root();
  const bool sequential = root.has("analysis") && root.table("analysis").has("sequential");
  if (!sequential || !holds_sessions(folder)) {
    return std::nullopt;
  }
  AnalysisRequest request;
  request.folder = folder;
  request.files = study_files(folder, Pilots::kLeftOut, protocol_of);
  request.threads = threads;
  return study_of(request.files.first).sequential(request);
}

bool has_ended(const std::optional<analysis::SequentialResult>& standing) {
  return standing && standing->verdict != analysis::SequentialVerdict::kGoOn;
}

std::vector<RosterNext> next_sessions(const Roster& roster,
                                      const std::optional<analysis::SequentialResult>& standing) {
  std::vector<RosterNext> next = roster.next;
  if (has_ended(standing)) {
    std::erase_if(next, [](const RosterNext& each) { return each.fresh; });
  }
  return next;
}

std::string words_without_next(const Roster& roster,
                               const std::optional<analysis::SequentialResult>& standing) {
  std::vector<std::string> running;
  for (const RosterPerson& person : roster.persons) {
    if (person.is_recorded_now() && !person.pilot) {
      running.push_back(person.subject);
    }
  }
  if (!running.empty()) {
    return fmt::format("{} {} being recorded; nobody else is next", fmt::join(running, ", "),
                       running.size() == 1 ? "is" : "are");
  }
  return has_ended(standing) ? "nobody is next" : "every planned participant has had every session";
}

}  // namespace haptrial::experiments
