#include "experiments/study/study_files.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <iterator>
#include <map>
#include <ranges>
#include <set>
#include <tuple>
#include <utility>

#include "core/base/alike_names.h"
#include "core/base/counted.h"
#include "core/base/definition/definition_changes.h"
#include "core/base/error.h"
#include "core/record/read/marked_trials.h"
#include "core/record/read/session_facts.h"
#include "core/record/read/session_reader.h"
#include "core/record/rows/answer_rows.h"
#include "experiments/runner/version.h"
#include "experiments/study/study_definitions.h"
#include "experiments/study/study_run.h"
#include "protocols/definition/definition.h"
#include "protocols/definition/groups.h"

namespace haptrial::experiments {
namespace {

namespace fs = std::filesystem;

struct Sorted {
  std::vector<fs::path> study;
  std::vector<fs::path> pilots;
  std::vector<fs::path> declined;
  std::vector<std::string> copies;
};

Sorted sorted_files(const fs::path& folder) {
  Sorted sorted;
  DistinctSessions distinct = distinct_sessions(session_files(folder));
  sorted.copies = std::move(distinct.copies);
  for (const fs::path& file : distinct.files) {
    const record::SessionReader reader(file);
    (is_declined(reader)   ? sorted.declined
     : reader.info().pilot ? sorted.pilots
                           : sorted.study)
        .push_back(file);
  }
  return sorted;
}

std::vector<fs::path> taken(const Sorted& sorted, const fs::path& folder, Pilots pilots) {
  const bool alone = pilots == Pilots::kAlone;
  const auto& files = alone ? sorted.pilots : sorted.study;
  if (files.empty() && sorted.study.empty() && sorted.pilots.empty()) {
    throw InputError(fmt::format("{}: holds only sessions of participants who did not consent",
                                 folder.string()));
  }
  if (files.empty()) {
    throw InputError(fmt::format("{}: holds {}", folder.string(),
                                 alone
                                     ? "no pilot sessions; leave --pilots out to analyse the study"
                                     : "only pilot sessions; analyse them with --pilots"));
  }
  return files;
}

std::string names_of(const std::vector<fs::path>& files) {
  std::string names;
  for (const fs::path& file : files) {
    names += (names.empty() ? "" : ", ") + file.filename().string();
  }
  return names;
}

/// The programs that recorded the sessions, and the one that analyses them now.
std::string remark_on_programs(const std::vector<fs::path>& files) {
  std::set<std::string> programs;
  bool imported = true;
  for (const fs::path& file : files) {
    const record::SessionReader reader(file);
    const record::SessionInfo& info = reader.info();
    imported = imported && !record::imported_from(reader).empty();
    programs.insert(fmt::format("haptrial {} ({})", info.program_version, info.program_commit));
  }
  return fmt::format("{} by {}; analysed by haptrial {} ({}).", imported ? "Imported" : "Recorded",
                     fmt::join(programs, " and "), program_version(), program_commit());
}

/// The tables that trials were imported from, which another program presented.
std::string remark_on_imports(const std::vector<fs::path>& files) {
  std::set<std::string> tables;
  for (const fs::path& file : files) {
    tables.insert(record::imported_from(record::SessionReader(file)));
  }
  tables.erase("");
  return tables.empty() ? ""
                        : fmt::format(
                              "Another program presented these trials, so that nothing is known of "
                              "devices and their times; imported from {}.",
                              fmt::join(tables, "; "));
}

/// Marks of experimenters, in words by participant, and how many trials they are on.
class MarkWords {
 public:
  void add(const std::string& subject, const record::MarkedTrial& mark) {
    trials_.insert({subject, mark.practice, mark.trial});
    own_[subject].push_back(fmt::format("{} {}: {}", mark.practice ? "practice trial" : "trial",
                                        mark.trial, mark.reason));
  }
  /// Adds "BEGINNING: 3 trials: P01 2 (trial 5: slipped; trial 9: phone); P02 1 (…)."
  void remark(const char* beginning, std::vector<std::string>& remarks) const {
    std::vector<std::string> people;
    for (const auto& [subject, marks] : own_) {
      people.push_back(fmt::format("{}, {} ({})", subject, counted(marks.size(), "mark", "marks"),
                                   fmt::join(marks, "; ")));
    }
    if (!people.empty()) {
      remarks.push_back(fmt::format("{}: {}: {}.", beginning,
                                    counted(trials_.size(), "trial", "trials"),
                                    fmt::join(people, "; ")));
    }
  }

 private:
  std::map<std::string, std::vector<std::string>> own_;
  std::set<std::tuple<std::string, bool, int>> trials_;
};

/// Adds what became of trials that experimenters marked as bad.
void remark_on_marks(const std::vector<fs::path>& files, std::vector<std::string>& remarks) {
  MarkWords left_out, kept, again;
  for (const fs::path& file : files) {
    const record::SessionReader reader(file);
    for (const record::MarkedTrial& mark : record::marked_trials(reader)) {
      (mark.left_out          ? left_out
       : mark.presented_again ? again
                              : kept)
          .add(reader.info().subject, mark);
    }
  }
  left_out.remark(
      "Marked as bad by the experimenter, and left out of the analysis as the definition's "
      "analysis.exclude_marked says",
      remarks);
  kept.remark("Marked as bad by the experimenter, and analysed all the same", remarks);
  again.remark("Marked as bad by the experimenter, and presented again, which is what is analysed",
               remarks);
}

/// Adds notes of the experimenters, answers that they took back, mistakes that participants
/// reported, and trials in which the loop was suspended.
void remark_on_trials(const std::vector<fs::path>& files, std::vector<std::string>& remarks) {
  std::vector<std::string> mistakes;
  std::vector<std::string> taken_back;
  std::vector<std::string> suspended;
  std::vector<std::string> notes;
  for (const fs::path& file : files) {
    const record::SessionReader reader(file);
    for (const record::EventRow& event : reader.events()) {
      const std::string line = fmt::format("{}, {}", reader.info().subject, event.text);
      if (event.kind == "participant_error") {
        mistakes.push_back(line);
      } else if (event.kind == "taken_back") {
        taken_back.push_back(line);
      } else if (event.kind == "suspended") {
        suspended.push_back(line);
      } else if (event.kind == "note" && !event.text.starts_with("console: ")) {
        notes.push_back(line);
      }
    }
  }
  if (!mistakes.empty()) {
    remarks.push_back(
        fmt::format("Answered by mistake as participants said at once, and analysed all the same: "
                    "{}: {}.",
                    counted(mistakes.size(), "trial", "trials"), fmt::join(mistakes, "; ")));
  }
  if (!taken_back.empty()) {
    remarks.push_back(fmt::format(
        "Taken back by the experimenter, and presented again, which is what is analysed: {}: {}.",
        counted(taken_back.size(), "trial", "trials"), fmt::join(taken_back, "; ")));
  }
  if (!suspended.empty()) {
    remarks.push_back(
        fmt::format("The loop was suspended, so that what was presented then lasted longer and a "
                    "reaction time over it is not known; analysed all the same: {}.",
                    fmt::join(suspended, "; ")));
  }
  if (!notes.empty()) {
    remarks.push_back(fmt::format("Notes of the experimenter: {}.", fmt::join(notes, "; ")));
  }
}

bool experimenter_consented(const fs::path& file) {
  const std::vector<record::EventRow> events = record::SessionReader(file).events();
  return std::any_of(events.begin(), events.end(), [](const record::EventRow& event) {
    return event.kind == "consent_by_experimenter";
  });
}

std::string remark_on_consent(const std::vector<fs::path>& files) {
  std::vector<fs::path> by_experimenter;
  std::copy_if(files.begin(), files.end(), std::back_inserter(by_experimenter),
               experimenter_consented);
  return by_experimenter.empty()
             ? ""
             : fmt::format(
                   "Consent was entered by the experimenter, with a reason in the file, "
                   "in {}: {}.",
                   counted(by_experimenter.size(), "session", "sessions"),
                   names_of(by_experimenter));
}

/// Files of one session of a participant that were recorded at different times.
std::string remark_on_repeated(const std::vector<fs::path>& files) {
  std::map<std::pair<std::string, std::uint64_t>, std::vector<fs::path>> sessions;
  for (const fs::path& file : files) {
    const record::SessionInfo info = record::SessionReader(file).info();
    sessions[{info.subject, info.session}].push_back(file);
  }
  std::vector<std::string> repeated;
  for (const auto& [session, own] : sessions) {
    if (own.size() > 1) {
      repeated.push_back(
          fmt::format("{} session {}: {}", session.first, session.second, names_of(own)));
    }
  }
  return repeated.empty() ? ""
                          : fmt::format("Recorded more than once, and all of it analysed: {}.",
                                        fmt::join(repeated, "; "));
}

/// Orders of conditions are balanced over the participants of one seed.
std::string remark_on_seeds(const std::vector<fs::path>& files) {
  std::map<std::uint64_t, std::vector<fs::path>> by_seed;
  for (const fs::path& file : files) {
    by_seed[record::SessionReader(file).info().seed].push_back(file);
  }
  std::vector<std::string> seeds;
  for (const auto& [seed, own] : by_seed) {
    seeds.push_back(fmt::format("seed {}: {}", seed, names_of(own)));
  }
  return seeds.size() < 2 ? ""
                          : fmt::format(
                                "Recorded with different seeds, over which orders are not "
                                "balanced: {}.",
                                fmt::join(seeds, "; "));
}

/// Warns of participants who may be one person with two names.
std::vector<std::string> remarks_on_names(const std::vector<fs::path>& files) {
  std::set<std::string> people;
  for (const fs::path& file : files) {
    people.insert(record::SessionReader(file).info().subject);
  }
  return alike_names_warnings("participants", {people.begin(), people.end()});
}

std::string remark_on_pilots(const Sorted& sorted, Pilots pilots) {
  if (pilots == Pilots::kAlone) {
    return "These are pilot sessions, not the study.";
  }
  return sorted.pilots.empty() ? ""
                               : fmt::format("Not analysed, because the session was a pilot: {}.",
                                             names_of(sorted.pilots));
}

/// The number of participants that a definition plans; 0 if it does not say so.
int planned_participants(const std::string& definition) {
  static const std::vector<std::string> kKey{"design.participants"};
  try {
    const auto values = definition_values(definition, kKey);
    return values.empty() ? 0 : std::stoi(values.begin()->second);
  } catch (const std::exception&) {
    return 0;
  }
}

}  // namespace

std::vector<std::size_t> files_that_stay(const std::vector<SessionCopy>& files) {
  const auto rank = [&](std::size_t i) {
    return std::pair(files[i].passes, -static_cast<std::ptrdiff_t>(files[i].name.size()));
  };
  std::map<record::SessionInfo::Identity, std::size_t> best;
  for (std::size_t i = 0; i < files.size(); ++i) {
    std::size_t& stays = best.try_emplace(files[i].identity, i).first->second;
    stays = rank(i) > rank(stays) ? i : stays;
  }
  std::vector<std::size_t> stay;
  for (const SessionCopy& file : files) {
    stay.push_back(best.at(file.identity));
  }
  return stay;
}

DistinctSessions distinct_sessions(const std::vector<fs::path>& files) {
  std::vector<SessionCopy> all;
  for (const fs::path& file : files) {
    const record::SessionReader reader(file);
    all.push_back({reader.info().identity(), reader.passes().size(), file.filename().string()});
  }
  const std::vector<std::size_t> stay = files_that_stay(all);
  DistinctSessions distinct;
  for (std::size_t i = 0; i < files.size(); ++i) {
    if (stay[i] == i) {
      distinct.files.push_back(files[i]);
    } else {
      distinct.copies.push_back(fmt::format("{} (of {})", all[i].name, all[stay[i]].name));
    }
  }
  return distinct;
}

bool is_declined(const record::SessionReader& reader) {
  const auto answers = reader.rows<record::AnswerRow>();
  return std::any_of(answers.begin(), answers.end(), [](const record::AnswerRow& row) {
    return row.item == "consent" && row.text == "declined";
  });
}

std::vector<std::string> unfinished_sessions(const fs::path& folder) {
  std::vector<std::string> names;
  std::error_code ignored;
  for (const auto& entry : fs::directory_iterator(folder, ignored)) {
    if (entry.path().extension() == ".partial") {
      names.push_back(entry.path().filename().string());
    }
  }
  std::sort(names.begin(), names.end());
  return names;
}

bool holds_sessions(const fs::path& folder) {
  std::error_code ignored;
  const fs::directory_iterator files(folder, ignored);
  return std::any_of(begin(files), end(files), [](const fs::directory_entry& entry) {
    return entry.path().extension() == ".h5" || entry.path().extension() == ".partial";
  });
}

std::vector<fs::path> files_of(const fs::path& folder, Pilots pilots) {
  return taken(sorted_files(folder), folder, pilots);
}

std::vector<fs::path> files_of_one_study(const fs::path& folder,
                                         const protocols::Protocol& protocol) {
  const std::vector<fs::path> files = files_of(folder, Pilots::kLeftOut);
  static_cast<void>(definition_remarks(protocol, files));
  return files;
}

record::SessionInfo largest_plan(const std::vector<fs::path>& files) {
  record::SessionInfo largest = record::SessionReader(files.front()).info();
  for (const fs::path& file : files) {
    record::SessionInfo info = record::SessionReader(file).info();
    if (info.definition != largest.definition &&
        planned_participants(info.definition) > planned_participants(largest.definition)) {
      largest = std::move(info);
    }
  }
  return largest;
}

StudyFiles study_files(const fs::path& folder, Pilots pilots, const ProtocolOf& protocol_of) {
  const Sorted sorted = sorted_files(folder);
  StudyFiles study;
  study.files = taken(sorted, folder, pilots);
  study.first = largest_plan(study.files);
  study.remarks = remarks_on_names(study.files);
  if (const std::string remark = remark_on_pilots(sorted, pilots); !remark.empty()) {
    study.remarks.push_back(remark);
  }
  if (!sorted.copies.empty()) {
    study.remarks.push_back(
        fmt::format("Not analysed, because another file holds the same session: {}.",
                    fmt::join(sorted.copies, ", ")));
  }
  if (const std::string remark = remark_on_repeated(study.files); !remark.empty()) {
    study.remarks.push_back(remark);
  }
  if (const std::string remark = remark_on_seeds(study.files); !remark.empty()) {
    study.remarks.push_back(remark);
  }
  if (!sorted.declined.empty()) {
    study.remarks.push_back(fmt::format(
        "Not analysed, because the participant did not consent: {}.", names_of(sorted.declined)));
  }
  if (const std::string remark = remark_on_consent(study.files); !remark.empty()) {
    study.remarks.push_back(remark);
  }
  remark_on_marks(study.files, study.remarks);
  remark_on_trials(study.files, study.remarks);
  if (const std::string remark = remark_on_imports(study.files); !remark.empty()) {
    study.remarks.push_back(remark);
  }
  study.remarks.push_back(remark_on_programs(study.files));
  const std::vector<std::string> changed =
      definition_remarks(protocol_of(study.first), study.files);
  study.remarks.insert(study.remarks.end(), changed.begin(), changed.end());
  return study;
}

std::vector<std::string> complete_participants(const std::vector<fs::path>& files,
                                               const protocols::Definition& definition) {
  using Start = std::pair<std::string, std::uint64_t>;  // time and number of the participant
  std::map<std::string, std::map<int, Start>> begun;    // by participant and session
  for (const fs::path& file : files) {
    const record::SessionInfo info = record::SessionReader(file).info();
    const Start here(info.start_utc, info.participant_number);
    const auto [first, is_new] =
        begun[info.subject].try_emplace(static_cast<int>(info.session), here);
    first->second = std::min(first->second, here);
  }
  std::map<std::string, Start> last;  // start of the last session by participant
  for (const auto& [participant, sessions] : begun) {
    const std::string group = definition.groups.size() > 1
                                  ? protocols::group_of(definition.groups, participant)
                                  : std::string();
    int had = 0;
    for (const auto& [session, start] : sessions) {
      had += definition.comes(session, group) ? 1 : 0;
    }
    if (had >= definition.sessions_of(group)) {
      last[participant] = std::ranges::max(std::views::values(sessions));
    }
  }
  std::vector<std::string> order;
  for (const auto& [participant, start] : last) {
    order.push_back(participant);
  }
  std::ranges::stable_sort(order, {}, [&](const std::string& each) { return last.at(each); });
  return order;
}

}  // namespace haptrial::experiments
