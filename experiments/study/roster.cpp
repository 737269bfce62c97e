#include "experiments/study/roster.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <set>
#include <tuple>

#include "core/base/error.h"
#include "core/base/shell_word.h"
#include "core/record/hdf5/file_lock.h"
#include "core/record/read/session_facts.h"
#include "core/record/read/session_reader.h"
#include "experiments/runner/devices.h"
#include "experiments/study/session_name.h"
#include "experiments/study/study_files.h"
#include "protocols/definition/groups.h"
#include "protocols/interface/study_rules.h"

namespace haptrial::experiments {
namespace {

namespace fs = std::filesystem;
using protocols::StudyGroup;

constexpr const char* kVirtual = "virtual";

struct FoundFile {
  fs::path file;
  record::SessionInfo info;
  RosterSession session;
  std::vector<std::string> devices;  // in their order
};

SessionState state_of(const fs::path& file, const record::SessionReader& reader) {
  if (file.extension() == ".partial") {
    return record::FileLock::taken(file) ? SessionState::kRunning : SessionState::kUnfinished;
  }
  if (is_declined(reader)) {
    return SessionState::kDeclined;
  }
  const auto events = reader.events();
  const bool aborted = std::any_of(events.begin(), events.end(), [](const record::EventRow& event) {
    return event.kind == record::kEndedForGood;
  });
  return aborted ? SessionState::kAborted : SessionState::kDone;
}

/// The devices of a session's last run, as its file names them.
std::vector<std::string> devices_of(const record::SessionReader& reader) {
  std::vector<std::string> devices{reader.info().device};
  for (const record::EventRow& event : reader.events()) {
    if (event.kind == kDevicesEvent) {
      devices = devices_in(event.text);
    }
  }
  return devices;
}

/// The session files of a folder, finished or not; what cannot be read gets a sentence.
std::vector<FoundFile> found_in(const fs::path& folder, std::vector<std::string>& remarks) {
  std::vector<fs::path> files;
  std::error_code ignored;
  for (const auto& entry : fs::directory_iterator(folder, ignored)) {
    if (entry.path().extension() == ".h5" || entry.path().extension() == ".partial") {
      files.push_back(entry.path());
    }
  }
  std::sort(files.begin(), files.end());
  std::vector<FoundFile> found;
  for (const fs::path& file : files) {
    try {
      const record::SessionReader reader(file);
      FoundFile one{file, reader.info(), {}, devices_of(reader)};
      one.session = {static_cast<int>(one.info.session), state_of(file, reader),
                     record::trial_progress(reader).done, file.filename().string()};
      found.push_back(std::move(one));
    } catch (const InputError& error) {
      remarks.push_back(fmt::format("Not counted, because it cannot be read: {}", error.what()));
    }
  }
  return found;
}

class RosterMaker {
 public:
  explicit RosterMaker(const RosterRequest& request) : request_(request), d_(*request.definition) {}

  Roster make() {
    roster_.sessions = d_.sessions();
    add_files(found_in(request_.folder, roster_.remarks), false);
    add_files(found_in(request_.folder / kExcludedFolder, roster_.remarks), true);
    roster_.seed = request_.seed.value_or(seed_.value_or(1));
    std::sort(roster_.persons.begin(), roster_.persons.end(), [](const auto& a, const auto& b) {
      return std::tie(a.pilot, a.excluded, a.subject) < std::tie(b.pilot, b.excluded, b.subject);
    });
    for (RosterPerson& person : roster_.persons) {
      complete(person);
    }
    add_groups();
    add_next();
    return std::move(roster_);
  }

 private:
  void add_files(const std::vector<FoundFile>& files, bool excluded) {
    std::vector<SessionCopy> copies;
    for (const FoundFile& found : files) {
      copies.push_back({found.info.identity(), static_cast<std::size_t>(found.session.trials),
                        found.session.file});
    }
    const std::vector<std::size_t> stay = files_that_stay(copies);
    for (std::size_t i = 0; i < files.size(); ++i) {
      const FoundFile& found = files[i];
      if (!found.info.pilot && !excluded) {
        check_study(found);
      }
      const record::SessionInfo& info = found.info;
      if (stay[i] != i) {
        roster_.remarks.push_back(fmt::format("Not counted, because {} holds the same session: {}.",
                                              files[stay[i]].session.file, found.session.file));
        continue;
      }
      auto at = std::find_if(roster_.persons.begin(), roster_.persons.end(), [&](const auto& each) {
        return each.subject == info.subject && each.pilot == info.pilot &&
               each.excluded == excluded;
      });
      if (at == roster_.persons.end()) {
        roster_.persons.push_back({info.subject,
                                   number_of_session(info),
                                   "",
                                   info.pilot,
                                   excluded,
                                   info.simulated,
                                   {},
                                   0,
                                   {}});
        at = roster_.persons.end() - 1;
      }
      if (at->session(found.session.session) != nullptr) {
        roster_.remarks.push_back(fmt::format(
            "{} has two files of session {}: {} and {}.", info.subject, found.session.session,
            at->session(found.session.session)->file, found.session.file));
      }
      if (number_of_session(info) != at->number) {
        roster_.remarks.push_back(fmt::format(
            "{} was recorded in the order of participant {}, and {} in that of {}.",
            at->sessions.front().file, at->number, found.session.file, number_of_session(info)));
      }
      at->sessions.push_back(found.session);
      if (!info.pilot && !excluded) {
        newest_ = found.info.start_utc > newest_.info.start_utc ? found : newest_;
      }
    }
  }

  void check_study(const FoundFile& found) {
    const DefinitionChanges changes =
        protocols::study_changes(*request_.protocol, found.info, d_.text, found.info.device);
    if (!changes.same_study()) {
      throw InputError(
          fmt::format("{}: was recorded with another definition than {}: {}; give the "
                      "folder of one study",
                      found.file.string(), d_.file_name, sentence_of(changes.binding)));
    }
    if (request_.any_seed) {
      return;
    }
    seed_ = request_.seed ? request_.seed : seed_ ? seed_ : found.info.seed;
    if (*seed_ != found.info.seed) {
      throw InputError(
          fmt::format("{}: was recorded with seed {}, not with {}; orders are balanced "
                      "over the sessions of one seed: haptrial roster --exclude takes out "
                      "who has another",
                      found.file.string(), found.info.seed, *seed_));
    }
  }

  std::string group_of(int number) const {
    return d_.groups.size() > 1 && number > 0 && number <= d_.design.participants
               ? protocols::group_of(d_.groups, std::to_string(number))
               : std::string();
  }

  void complete(RosterPerson& person) const {
    person.group = group_of(person.number);
    std::sort(person.sessions.begin(), person.sessions.end(),
              [](const auto& a, const auto& b) { return a.session < b.session; });
    for (int session = roster_.sessions; session >= 1 && !person.excluded && !person.declined();
         --session) {
      const RosterSession* there = person.session(session);
      const bool open = there == nullptr ? d_.comes(session, person.group)
                                         : there->state == SessionState::kUnfinished;
      if (open) {
        person.next = session;
      }
    }
    if (request_.find_case && person.next > 0) {
      person.next_case = case_of(person);
      person.next = person.next_case.name.empty() ? 0 : person.next;
    }
  }

  /// The case of a person's next session: its own if it is to be resumed, else by the sessions
  /// before it that came to their end.
  NextCase case_of(const RosterPerson& person) const {
    if (const RosterSession* begun = person.session(person.next)) {
      const record::SessionReader reader(request_.folder / begun->file);
      if (std::string name = record::case_in(reader.events()); !name.empty()) {
        return {std::move(name), "begun"};
      }
    }
    std::vector<fs::path> files;
    for (const RosterSession& each : person.sessions) {
      if (each.state == SessionState::kDone && each.session < person.next) {
        files.push_back(request_.folder / each.file);
      }
    }
    return request_.find_case(files);
  }

  void add_groups() {
    for (const StudyGroup& group : d_.groups) {
      const std::string name = d_.groups.size() > 1 ? group.name : "";
      roster_.groups.push_back({name, group.planned > 0 ? group.planned : d_.design.participants, 0,
                                0, d_.sessions_of(name)});
    }
    std::map<int, std::string> holders;
    for (const RosterPerson& person : roster_.persons) {
      if (person.pilot || person.excluded || person.never_took_part()) {
        continue;
      }
      if (person.number < 1 || person.number > d_.design.participants) {
        roster_.remarks.push_back(fmt::format("{} has no place in the plan of {} participants.",
                                              person.subject, d_.design.participants));
        continue;
      }
      const auto [holder, fresh] = holders.emplace(person.number, person.subject);
      if (!fresh) {
        roster_.remarks.push_back(fmt::format("{} and {} have the same number, so the same order.",
                                              holder->second, person.subject));
        continue;
      }
      RosterGroup& group = of(person.group);
      ++group.begun;
      const bool finished = person.next == 0 && !person.declined() && !person.is_recorded_now();
      group.finished += finished ? 1 : 0;
      taken_.insert(person.number);
    }
  }

  /// The first session to which participants of a group come.
  int first_of(const std::string& group) const {
    int session = 1;
    while (session < roster_.sessions && !d_.comes(session, group)) {
      ++session;
    }
    return session;
  }

  RosterGroup& of(const std::string& name) {
    return *std::find_if(roster_.groups.begin(), roster_.groups.end(),
                         [&](const RosterGroup& group) { return group.name == name; });
  }

  /// New participants of each group that has a place, the emptiest group first; then who has
  /// sessions left, by number.
  void add_next() {
    std::vector<const RosterGroup*> open;
    for (const RosterGroup& group : roster_.groups) {
      if (group.begun < group.planned) {
        open.push_back(&group);
      }
    }
    std::stable_sort(open.begin(), open.end(), [](const RosterGroup* a, const RosterGroup* b) {
      return a->begun * b->planned < b->begun * a->planned;
    });
    for (const RosterGroup* group : open) {
      for (int number = 1; number <= d_.design.participants; ++number) {
        if (!taken_.contains(number) && group_of(number) == group->name) {
          RosterNext next{subject_for(number), number, group->name, first_of(group->name)};
          next.next_case = request_.find_case ? request_.find_case({}) : NextCase{};
          add_next(std::move(next));
          break;
        }
      }
    }
    for (const RosterPerson& person : roster_.persons) {
      if (!person.pilot && person.next > 0) {
        const bool resume = person.session(person.next) != nullptr;
        RosterNext next{person.subject, person.number, person.group, person.next, false, resume};
        next.next_case = person.next_case;
        add_next(std::move(next));
      }
    }
  }

  /// Identifier in the form of those before: "P07".
  std::string subject_for(int number) const {
    std::string prefix = "P";
    std::size_t digits = 2;
    for (const RosterPerson& person : roster_.persons) {
      if (!person.pilot && !person.excluded && number_of_subject(person.subject) > 0) {
        const std::size_t letters = person.subject.find_last_not_of("0123456789") + 1;
        prefix = person.subject.substr(0, letters);
        digits = person.subject.size() - letters;
        break;
      }
    }
    return replacement_of(fmt::format("{}{:0{}}", prefix, number, digits),
                          [this](const std::string& name) { return is_known(name); });
  }
  bool is_known(const std::string& subject) const {
    return std::any_of(roster_.persons.begin(), roster_.persons.end(),
                       [&](const RosterPerson& person) { return person.subject == subject; });
  }

  void add_next(RosterNext next) {
    protocols::SessionPlace place;
    place.subject = next.subject;
    place.participant = std::max(0, next.number - 1);
    place.session = next.session;
    place.seed = roster_.seed;
    give_seeds(place);
    try {
      next.blocks = request_.protocol->blocks(d_, place);
    } catch (const InputError& error) {
      roster_.remarks.push_back(error.what());
    }
    next.session_name = d_.session_plan(next.session).name;
    next.command = fmt::format("haptrial run {} --subject {}", shell_word(request_.definition_file),
                               next.subject);
    next.command += roster_.sessions > 1 ? fmt::format(" --session {}", next.session) : "";
    next.command += next.number > 0 && next.number != number_of_subject(next.subject)
                        ? fmt::format(" --participant {}", next.number)
                        : "";
    next.command += next.resume ? " --resume" : "";
    const bool led = !d_.tutoring.led.groups.empty() &&
                     d_.is_led(next.session, {1, next.number - 1, next.group});
    next.command += led ? " --tutor FILE:TRIAL" : "";
    for (const std::string& device : newest_.devices) {
      const bool left_out = device.empty() || newest_.devices.front() == kVirtual;
      next.command += left_out ? "" : fmt::format(" --device {}", shell_word(device));
    }
    next.command += roster_.seed != 1 ? fmt::format(" --seed {}", roster_.seed) : "";
    next.command += fmt::format(" --out {}", shell_word(request_.folder.string()));
    roster_.next.push_back(std::move(next));
  }

  const RosterRequest& request_;
  const protocols::Definition& d_;
  std::optional<std::uint64_t> seed_;
  FoundFile newest_;     // of the study
  std::set<int> taken_;  // numbers
  Roster roster_;
};

}  // namespace

const char* name_of(SessionState state) {
  switch (state) {
    case SessionState::kAborted:
      return "aborted";
    case SessionState::kDeclined:
      return "declined";
    case SessionState::kUnfinished:
      return "unfinished";
    case SessionState::kRunning:
      return "running";
    case SessionState::kDone:
      break;
  }
  return "done";
}

const RosterSession* RosterPerson::session(int wanted) const {
  const auto at = std::find_if(sessions.begin(), sessions.end(),
                               [&](const RosterSession& each) { return each.session == wanted; });
  return at != sessions.end() ? &*at : nullptr;
}

static bool has_one(const RosterPerson& person, SessionState state) {
  return std::ranges::find(person.sessions, state, &RosterSession::state) != person.sessions.end();
}

bool RosterPerson::is_recorded_now() const { return has_one(*this, SessionState::kRunning); }

bool RosterPerson::declined() const { return has_one(*this, SessionState::kDeclined); }

bool RosterPerson::never_took_part() const {
  return declined() && std::all_of(sessions.begin(), sessions.end(),
                                   [](const RosterSession& each) { return each.trials == 0; });
}

Roster make_roster(const RosterRequest& request) {
  if (std::filesystem::exists(request.folder) && !std::filesystem::is_directory(request.folder)) {
    throw InputError(request.folder.string() +
                     ": not a folder; give the folder of the session files");
  }
  return RosterMaker(request).make();
}

}  // namespace haptrial::experiments
