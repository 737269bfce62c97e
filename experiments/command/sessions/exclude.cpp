#include "experiments/command/sessions/exclude.h"

#include <fmt/format.h>

#include <algorithm>

#include "analysis/files/delimited.h"
#include "analysis/files/sha256.h"
#include "core/base/error.h"
#include "core/base/file_text.h"
#include "experiments/plan/plan_log.h"
#include "experiments/study/session_name.h"

namespace haptrial::experiments {
namespace {

namespace fs = std::filesystem;

void add_reason(const fs::path& file, const std::string& subject, const std::string& reason) {
  std::string text = fs::exists(file) ? file_text(file) : std::string("participant,reason\n");
  exchange::RowText row(text, exchange::Delimited::kCsv);
  row.add(subject).add(reason);
  row.end();
  write_text(file, text);
}

}  // namespace

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

}  // namespace haptrial::experiments
