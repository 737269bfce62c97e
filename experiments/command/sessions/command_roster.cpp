#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

#include "analysis/files/delimited.h"
#include "analysis/files/sha256.h"
#include "core/base/counted.h"
#include "core/base/error.h"
#include "core/base/file_text.h"
#include "core/base/whole_file.h"
#include "experiments/command/arguments.h"
#include "experiments/command/sessions/next_session.h"
#include "experiments/command/subcommand.h"
#include "experiments/plan/plan_log.h"
#include "experiments/plan/study_plan.h"
#include "experiments/studies/experiment.h"
#include "experiments/study/roster.h"
#include "experiments/study/session_name.h"
#include "experiments/study/session_times.h"
#include "experiments/study/study_files.h"
#include "experiments/study/study_run.h"

namespace haptrial::experiments {
namespace {

namespace fs = std::filesystem;

void add_reason(const fs::path& file, const std::string& subject, const std::string& reason) {
  std::string text = fs::exists(file) ? file_text(file) : std::string("participant,reason\n");
  exchange::RowText row(text, exchange::Delimited::kCsv);
  row.add(subject).add(reason);
  row.end();
  write_whole(file, text);
}

/// Takes a participant out of a study: moves all files of theirs that are no pilots into the folder
/// "excluded" beside the others, where no analysis reads them, and adds the reason as a row to
/// reasons.csv there.
/// @param roster  of the folder
/// @throws InputError for somebody who has no session there, whose session is being recorded, or
/// whose files are excluded under the same names; nothing is moved then
void exclude(const Roster& roster, const fs::path& folder, const std::string& subject,
             const std::string& reason) {
  const auto person =
      std::find_if(roster.persons.begin(), roster.persons.end(), [&](const RosterPerson& each) {
        return each.subject == subject && !each.pilot && !each.excluded;
      });
  if (person == roster.persons.end()) {
    throw InputError(fmt::format(
        "--exclude is {}, who has no session of the study in {}; the list without --exclude says "
        "who has one",
        subject, folder.string()));
  }
  const fs::path excluded = folder / kExcludedFolder;
  for (const RosterSession& session : person->sessions) {
    if (session.state == SessionState::kRunning) {
      throw InputError(
          fmt::format("--exclude is {}, whose session {} is being recorded; end it "
                      "first",
                      subject, session.session));
    }
    if (fs::exists(excluded / session.file)) {
      throw InputError(fmt::format("{}: exists already, so {} cannot be moved there; rename it",
                                   (excluded / session.file).string(), session.file));
    }
  }
  fs::create_directories(excluded);
  add_reason(excluded / "reasons.csv", subject, reason);
  std::vector<std::string> digests;
  for (const RosterSession& session : person->sessions) {
    fs::rename(folder / session.file, excluded / session.file);
    digests.push_back(analysis::sha256_of_file(excluded / session.file));
  }
  note_files(folder, kExcluded, digests);
}

struct RosterOptions {
  std::string definition;
  std::string folder;
  std::optional<std::string> seed;
  std::string json;
  std::string csv;
  std::string exclude;
  std::string because;
  std::string rehearsal;
  std::optional<double> setup;
  std::optional<int> jobs;
};

using Row = std::vector<std::string>;

std::string sessions_in(const RosterPerson& person, SessionState state, int sessions) {
  std::string all;
  for (const RosterSession& each : person.sessions) {
    if (each.state == state) {
      all += (all.empty() ? "" : " ") + std::to_string(each.session);
    }
  }
  return sessions > 1 || all.empty() ? all : "yes";
}

std::string standing_of(const RosterPerson& person) {
  return person.pilot        ? "pilot"
         : person.excluded   ? "excluded"
         : person.declined() ? "declined"
         : person.simulated  ? "simulated"
                             : "";
}

/// Columns as wide as their longest entry.
void print_table(const std::vector<Row>& rows) {
  std::vector<std::size_t> widths(rows.front().size());
  for (const Row& row : rows) {
    for (std::size_t i = 0; i < row.size(); ++i) {
      widths[i] = std::max(widths[i], row[i].size());
    }
  }
  for (const Row& row : rows) {
    std::string line;
    for (std::size_t i = 0; i < row.size(); ++i) {
      line += fmt::format("{:<{}}  ", row[i], widths[i]);
    }
    line.erase(line.find_last_not_of(' ') + 1);
    fmt::print("{}\n", line);
  }
}

void print_persons(const Roster& roster) {
  std::vector<Row> rows{{"participant", "group", "done", "aborted", "unfinished", "next", "note"}};
  for (const RosterPerson& person : roster.persons) {
    const std::string running = sessions_in(person, SessionState::kRunning, 2);
    rows.push_back({person.subject, person.group.empty() ? "-" : person.group,
                    sessions_in(person, SessionState::kDone, roster.sessions),
                    sessions_in(person, SessionState::kAborted, roster.sessions),
                    sessions_in(person, SessionState::kUnfinished, roster.sessions),
                    person.next == 0 || person.pilot ? "-" : std::to_string(person.next),
                    running.empty() ? standing_of(person) : "recording session " + running});
  }
  print_table(rows);
}

/// @param standing  of a study that may end early
void print_roster(const Roster& roster, const std::optional<analysis::SequentialResult>& standing) {
  if (roster.persons.empty()) {
    fmt::print("nobody has a session yet\n");
  } else {
    print_persons(roster);
  }
  fmt::print("\n");
  for (const RosterGroup& group : roster.groups) {
    fmt::print("{}{} of {} begun, {} with {}\n", group.name.empty() ? "" : group.name + ": ",
               group.begun, counted(group.planned, "participant", "participants"), group.finished,
               roster.sessions > 1 ? "every session" : "their session");
  }
  for (const std::string& remark : roster.remarks) {
    fmt::print("{}\n", remark);
  }
  if (standing) {
    fmt::print("{}\n", words_of(*standing));
  }
  const std::vector<RosterNext> all = next_sessions(roster, standing);
  for (const RosterNext& next : all) {
    fmt::print("{}: {}\n      {}\n", &next == all.data() ? "next" : "or",
               words_of(next, roster.sessions), next.command);
  }
  if (all.empty()) {
    fmt::print("{}\n", words_without_next(roster, standing));
  }
}

/// Times of a rehearsal, or of the sessions that the study has had; nothing without either.
std::optional<SessionTimes> known_times(const RosterOptions& options,
                                        const protocols::Definition& d) {
  if (!options.rehearsal.empty()) {
    return session_times(session_files(options.rehearsal), d);
  }
  return recorded_times(options.folder, d);
}

/// How long the rest of the study takes in sessions.
void print_to_come(const Roster& roster, const RosterOptions& options,
                   const protocols::Definition& d) {
  const int left = sessions_to_come(roster);
  if (const auto times = left > 0 ? known_times(options, d) : std::nullopt) {
    fmt::print("to come: {}\n", lab_time(*times, left, checked_setup(options.setup)));
  } else if (left > 0) {
    const double seconds = session_seconds(d, d.design.trials);
    fmt::print("to come: {} of at most about {} each, {:.1f} hours in all, pages not counted\n",
               counted(left, "session", "sessions"), planned_minutes(seconds),
               left * seconds / 3600.0);
  }
}

/// Says if the data has been kept for as long as the plan beside it states.
void print_retention(const fs::path& folder) {
  const auto plan = plan_in(folder);
  const std::string over =
      plan ? retention_sentence(read_study_plan(*plan), utc_now().substr(0, 10)) : "";
  if (!over.empty()) {
    fmt::print("{}\n", over);
  }
}

std::string json_of(const Roster& roster,
                    const std::optional<analysis::SequentialResult>& standing) {
  nlohmann::ordered_json json;
  json["ended"] = has_ended(standing);
  json["standing"] = standing ? words_of(*standing) : "";
  json["sessions"] = roster.sessions;
  json["seed"] = roster.seed;
  json["groups"] = nlohmann::ordered_json::array();
  for (const RosterGroup& group : roster.groups) {
    json["groups"].push_back({{"name", group.name},
                              {"planned", group.planned},
                              {"begun", group.begun},
                              {"finished", group.finished}});
  }
  json["participants"] = nlohmann::ordered_json::array();
  for (const RosterPerson& person : roster.persons) {
    nlohmann::ordered_json own{{"subject", person.subject},   {"number", person.number},
                               {"group", person.group},       {"pilot", person.pilot},
                               {"excluded", person.excluded}, {"simulated", person.simulated},
                               {"next_session", person.next}};
    own["sessions"] = nlohmann::ordered_json::array();
    for (const RosterSession& each : person.sessions) {
      own["sessions"].push_back({{"session", each.session},
                                 {"state", name_of(each.state)},
                                 {"trials", each.trials},
                                 {"file", each.file}});
    }
    json["participants"].push_back(std::move(own));
  }
  json["next"] = nlohmann::ordered_json::array();
  for (const RosterNext& next : next_sessions(roster, standing)) {
    json["next"].push_back({{"subject", next.subject},
                            {"number", next.number},
                            {"group", next.group},
                            {"session", next.session},
                            {"new", next.fresh},
                            {"resume", next.resume},
                            {"blocks", next.blocks},
                            {"case", next.next_case.name},
                            {"why", next.next_case.why},
                            {"command", next.command}});
  }
  json["remarks"] = roster.remarks;
  return json.dump(2) + "\n";
}

std::string csv_of(const Roster& roster) {
  std::string text;
  exchange::RowText row(text, exchange::Delimited::kCsv);
  for (const char* name : {"participant", "number", "group", "pilot", "excluded", "simulated",
                           "session", "state", "trials", "file", "next_session"}) {
    row.add(name);
  }
  row.end();
  for (const RosterPerson& person : roster.persons) {
    for (const RosterSession& each : person.sessions) {
      row.add(person.subject).add(person.number).add(person.group);
      row.add(person.pilot ? 1 : 0).add(person.excluded ? 1 : 0).add(person.simulated ? 1 : 0);
      row.add(each.session).add(name_of(each.state)).add(each.trials).add(each.file);
      row.add(person.next).end();
    }
  }
  return text;
}

void write_new(const std::string& file, const std::string& text) {
  if (file.empty()) {
    return;
  }
  WholeFile out(file);
  out.write(text);
  out.finish();
  fmt::print("roster: {}\n", file);
}

int roster(const RosterOptions& options) {
  const Experiment experiment = load_experiment(options.definition);
  RosterRequest request;
  request.protocol = &experiment.study->protocol();
  request.definition = experiment.definition.get();
  request.definition_file = options.definition;
  request.folder = options.folder;
  request.find_case = find_case_of(experiment, options.definition);
  if (options.seed) {
    request.seed = checked_seed(*options.seed);
  }
  if (!options.exclude.empty()) {
    RosterRequest all = request;
    all.any_seed = true;
    exclude(make_roster(all), options.folder, options.exclude, options.because);
  }
  const Roster roster = make_roster(request);
  const auto standing = study_standing(experiment, options.folder, checked_jobs(options.jobs));
  print_roster(roster, standing);
  if (!has_ended(standing)) {
    print_to_come(roster, options, *experiment.definition);
  }
  print_retention(options.folder);
  write_new(options.json, json_of(roster, standing));
  write_new(options.csv, csv_of(roster));
  return 0;
}

}  // namespace

void add_roster(CLI::App& app, int& status) {
  CLI::App* sub =
      subcommand(app, "roster", "Show who has done what in a study, and who is next",
                 "haptrial roster curl_field out/curl_field",
                 {"the same as JSON or as a table if asked for", "guide-experimenter.md"});
  auto& o = options_of<RosterOptions>(*sub, status, roster);
  sub->add_option("DEFINITION", o.definition, "Experiment definition (.toml)")->required();
  sub->add_option("FOLDER", o.folder, "Folder of the session files; need not be there yet")
      ->required();
  sub->add_option(
      "--seed", o.seed,
      "Seed of the study, for orders (default: that of the sessions; 1 if there are none)");
  sub->add_option("--json", o.json, "New file for the roster as JSON");
  sub->add_option("--csv", o.csv, "New file for the roster as a table, a row for each session");
  sub->add_option("--rehearsal", o.rehearsal,
                  "Folder of a dry run whose sessions say how long those to come take (default: "
                  "the sessions of FOLDER)");
  sub->add_option("--setup", o.setup,
                  "Minutes in the lab between two sessions, for the time that is to come");
  sub->add_option("--jobs", o.jobs, kJobsHelp);
  auto* exclude = sub->add_option("--exclude", o.exclude,
                                  "Participant whose files are moved into the folder excluded; the "
                                  "next new participant gets the place");
  auto* because = sub->add_option("--because", o.because, "Why, for excluded/reasons.csv");
  exclude->needs(because);
  because->needs(exclude);
}

}  // namespace haptrial::experiments
