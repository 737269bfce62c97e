#include "analysis/exchange/export_sessions.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <map>
#include <set>

#include "core/base/definition/table.h"
#include "core/base/error.h"
#include "core/base/parallel.h"
#include "core/record/read/session_facts.h"
#include "core/record/read/session_reader.h"

namespace haptrial::exchange {
namespace {

namespace fs = std::filesystem;

void refuse_twins(const std::vector<ExportSession>& sessions) {
  std::set<fs::path> seen;
  std::map<record::SessionInfo::Identity, fs::path> begun;
  for (const auto& session : sessions) {
    std::error_code error;
    if (!seen.insert(fs::canonical(session.file, error)).second) {
      throw InputError(
          fmt::format("{}: is given twice; give each session once", session.file.string()));
    }
    const auto [twin, is_new] = begun.try_emplace(session.info.identity(), session.file);
    if (!is_new) {
      throw InputError(fmt::format("{}: holds the same session as {}; give each session once",
                                   session.file.string(), twin->second.string()));
    }
  }
}

/// Numbers sessions as the files say. A subject who has one number alone several times, as in
/// studies of one session that was repeated, has them in the order of start.
/// @throws InputError for a subject who has a number twice and others beside it
void number_sessions(std::vector<ExportSession>& sessions) {
  std::map<std::string, std::map<std::uint64_t, const ExportSession*>> known;
  std::map<std::string, std::pair<const ExportSession*, const ExportSession*>> twice;
  for (const auto& session : sessions) {
    const auto [first, fresh] =
        known[session.info.subject].try_emplace(session.info.session, &session);
    if (!fresh) {
      twice.try_emplace(session.info.subject, first->second, &session);
    }
  }
  for (const auto& [subject, files] : twice) {
    if (known[subject].size() > 1) {
      throw InputError(fmt::format("{}: is session {} of {}, as {} is; give one of them",
                                   files.second->file.string(), files.first->info.session, subject,
                                   files.first->file.string()));
    }
  }
  std::map<std::string, int> count;
  for (auto& session : sessions) {
    const int place = ++count[session.info.subject];
    session.number =
        twice.contains(session.info.subject) ? place : static_cast<int>(session.info.session);
  }
}

}  // namespace

void Counter::check() const {
  if (stopped_.load()) {
    throw RunError("the export was stopped");
  }
}

std::vector<ExportSession> sessions_to_export(std::span<const fs::path> files) {
  if (files.empty()) {
    throw InputError("there is no session file to export");
  }
  std::vector<ExportSession> sessions;
  for (const auto& file : files) {
    const record::SessionReader reader(file);
    sessions.push_back({file, reader.info(), reader.sample_count(), reader.passes().size(),
                        !reader.stimuli().empty(), record::is_mirrored(reader)});
  }
  refuse_twins(sessions);
  std::sort(sessions.begin(), sessions.end(), [](const auto& a, const auto& b) {
    return std::tie(a.info.subject, a.info.start_utc, a.file) <
           std::tie(b.info.subject, b.info.start_utc, b.file);
  });
  number_sessions(sessions);
  std::map<std::string, int> count;
  for (auto& session : sessions) {
    session.first = ++count[session.info.subject] == 1;
  }
  for (auto& session : sessions) {
    session.of = count[session.info.subject];
  }
  return sessions;
}

const char* axes_of(const ExportSession& session) {
  return session.mirrored
             ? "x to the participant's left, as the session was mirrored for a left-handed "
               "participant, y up, z towards the participant"
             : "x to the participant's right, y up, z towards the participant";
}

void refuse_imported(const ExportSession& session, const char* option) {
  if (!record::imported_from(record::SessionReader(session.file)).empty()) {
    throw InputError(fmt::format(
        "{}: was imported, so that no time of a trial is known, which {} needs; use --csv",
        session.file.string(), option));
  }
}

std::string experiment_name(const record::SessionInfo& info) {
  const std::string of_file = fs::path(info.definition_name).stem().string();
  try {
    Table root = Table::parse(info.definition, info.definition_name);
    if (root.has("experiment")) {
      Table experiment = root.table("experiment");
      const std::string name = experiment.has("name") ? experiment.text("name") : "";
      return name.empty() ? of_file : name;
    }
  } catch (const InputError&) {
    // A session file may hold any text: then it has no name.
  }
  return of_file;
}

std::uint64_t total_samples(std::span<const ExportSession> sessions) {
  std::uint64_t total = 0;
  for (const auto& session : sessions) {
    total += session.samples;
  }
  return total;
}

void share_out(std::size_t count, int jobs, const std::function<void(std::size_t, Counter&)>& work,
               const Watch& watch) {
  Counter counter;
  SharedWork shared(count, jobs, [&] { return [&](std::size_t i) { work(i, counter); }; });
  try {
    while (!shared.ended_within(std::chrono::milliseconds(10))) {
      watch(counter.samples());
    }
    watch(counter.samples());
  } catch (...) {
    counter.stop();
    throw;
  }
  shared.finish();
}

}  // namespace haptrial::exchange
