#include "experiments/study/study_run.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <chrono>
#include <exception>
#include <mutex>
#include <thread>

#include "core/base/counted.h"
#include "core/base/error.h"
#include "core/base/fnv.h"
#include "core/base/parallel.h"
#include "experiments/control/progress.h"
#include "experiments/control/signals.h"
#include "experiments/plan/study_plan.h"
#include "experiments/runner/session.h"
#include "experiments/runner/version.h"
#include "experiments/study/session_name.h"
#include "experiments/study/shared_work.h"
#include "experiments/study/taught_session.h"
#include "protocols/definition/groups.h"

namespace haptrial::experiments {
namespace fs = std::filesystem;
namespace {

/// A new folder, made by this run alone; taken back if the run fails.
class OutputFolder {
 public:
  explicit OutputFolder(fs::path folder) : folder_(std::move(folder)) {
    std::error_code error;
    if (const fs::path parent = folder_.lexically_normal().parent_path(); !parent.empty()) {
      fs::create_directories(parent, error);
    }
    // Making a folder is the one step that only one of two runs can do.
    const bool made = !error && fs::create_directory(folder_, error);
    if (error && !fs::exists(folder_)) {
      throw InputError(
          fmt::format("{}: the folder cannot be created ({})", folder_.string(), error.message()));
    }
    if (!made) {
      throw InputError(
          fmt::format("{}: exists already; choose a new folder with --out", folder_.string()));
    }
  }
  ~OutputFolder() {
    if (!keep_) {
      std::error_code ignored;
      fs::remove_all(folder_, ignored);
    }
  }
  OutputFolder(const OutputFolder&) = delete;
  OutputFolder& operator=(const OutputFolder&) = delete;
  void keep() { keep_ = true; }

 private:
  fs::path folder_;
  bool keep_{false};
};

/// Shares the participants out over threads and gathers what came of them.
class SessionWorkers {
 public:
  /// @param first  with the definition, to be completed for each participant
  /// @param parts  null: every session is run
  SessionWorkers(const SessionRequest& first, double ticks_each, const DryRun& dry_run,
                 DryParts* parts = nullptr)
      : first_(first),
        setup_(*first.definition),
        ticks_each_(ticks_each),
        dry_run_(dry_run),
        units_(planned_sessions(*first.definition, dry_run.participants, dry_run.session)),
        parts_(parts) {}

  DryRunSummary run() {
    const auto start = std::chrono::steady_clock::now();
    SharedWork sessions(static_cast<std::size_t>(count()), dry_run_.jobs, [this] {
      return [this](std::size_t i) {
        work((static_cast<int>(i) + static_cast<int>(dry_run_.start * count())) % count());
      };
    });
    show_progress(sessions);
    sessions.finish();
    wait_for_others();
    if (failure_) {
      std::rethrow_exception(failure_);
    }
    summary_.elapsed_seconds =
        std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    summary_.recorded_seconds = static_cast<double>(summary_.ticks) / setup_.rate;
    return summary_;
  }

 private:
  /// The first failure stops the others, whose own failure then says nothing.
  void work(int place) {
    if (cancel_) {
      return;
    }
    try {
      if (dry_run_.find_case) {
        run_cases(place);
      } else if (parts_ != nullptr) {
        parts_->run(static_cast<std::size_t>(place), request(place).file,
                    [&] { run_one(request(place)); });
      } else {
        run_one(request(place));
      }
    } catch (...) {
      const std::lock_guard lock(mutex_);
      if (!failure_) {
        failure_ = std::current_exception();
      }
      cancel_ = true;
    }
    ++finished_;
  }

  /// A participant's sessions one after the other, each of the case that follows from those before.
  void run_cases(int participant) {
    std::vector<fs::path> done;
    for (const PlannedSession& unit : units_) {
      const NextCase next =
          unit.participant == participant && !cancel_ ? dry_run_.find_case(done) : NextCase{};
      if (next.name.empty()) {
        continue;
      }
      SessionRequest one = request(unit);
      const auto definition = one.protocol->of_case(setup_, next.name);
      one.definition = definition.get();
      run_one(one);
      done.push_back(one.file);
    }
  }

  void run_one(const SessionRequest& request) {
    const SessionSummary done =
        dry_run_.taught ? run_taught_session(request, kTeaching) : run_session(request);
    const std::lock_guard lock(mutex_);
    ++summary_.sessions;
    summary_.ticks += done.ticks;
    summary_.passes += done.passes;
    summary_.aborted_passes += done.aborted_passes;
    summary_.given_up += done.given_up ? 1 : 0;
  }

  /// Sessions that other processes run: each is there in the end, or its process died.
  void wait_for_others() {
    constexpr auto kPause = std::chrono::milliseconds(100);
    while (parts_ != nullptr && !cancel_ && !interrupted()) {
      const std::vector<std::size_t> others = parts_->elsewhere();
      if (others.empty()) {
        return;
      }
      std::this_thread::sleep_for(kPause);
      for (const std::size_t place : others) {
        work(static_cast<int>(place));
      }
    }
  }

  /// Units of work: sessions, or with a curriculum participants.
  int count() const {
    return dry_run_.find_case ? dry_run_.participants : static_cast<int>(units_.size());
  }

  /// @param place  participant after participant, each with the sessions in their order
  SessionRequest request(int place) { return request(units_[static_cast<std::size_t>(place)]); }

  SessionRequest request(const PlannedSession& unit) {
    const auto [participant, session] = unit;
    SessionRequest r = first_;
    r.session = session;
    r.subject = participant_name(participant);
    r.participant = participant;
    r.seed = dry_run_.seed;
    r.file = dry_run_.folder / session_file_name(r.subject, r.session, setup_.sessions());
    r.frames_per_pass = dry_run_.frames_per_pass;
    r.frames_folder = dry_run_.folder / "frames";
    r.max_trials = dry_run_.max_trials;
    r.tutor = dry_run_.tutor;
    r.ticks = &ticks_;
    r.cancel = &cancel_;
    return r;
  }

  void show_progress(SharedWork& sessions) {
    Progress progress("dry run", ticks_each_ * count());
    while (!sessions.ended_within(std::chrono::milliseconds(20)) && !cancel_) {
      const auto done = static_cast<double>(ticks_.load(std::memory_order_relaxed));
      progress.update(
          done, count() == 1 ? "" : fmt::format("{} of {} sessions", finished_.load(), count()),
          setup_.rate);
    }
  }

  const SessionRequest& first_;
  const protocols::Definition& setup_;
  double ticks_each_;
  const DryRun& dry_run_;
  std::vector<PlannedSession> units_;
  DryParts* parts_;
  std::atomic<int> finished_{0};
  std::atomic<std::uint64_t> ticks_{0};
  std::atomic<bool> cancel_{false};
  std::mutex mutex_;  // the two below
  DryRunSummary summary_;
  std::exception_ptr failure_;
};

/// The plan of the sessions, before the first of them.
void take_plan(const DryRun& dry_run) {
  if (!dry_run.definition.empty()) {
    adopt_plan(dry_run.definition, dry_run.folder);
  }
}

/// Everything on which the sessions of a dry run depend.
std::string facts_of(const protocols::Definition& definition, const DryRun& dry_run) {
  const std::string language =
      definition.language.empty() ? std::string() : ", language " + definition.language;
  const std::string scripts =
      definition.scripts().empty()
          ? std::string()
          : fmt::format("# scripts {:016x} (FNV-1a)\n", fnv1a(definition.scripts()));
  return fmt::format("# haptrial {} ({}), dry run: seed {}, trials {}, session {}{} (0: all)\n{}{}",
                     program_version(), program_commit(), dry_run.seed, dry_run.max_trials,
                     dry_run.session, language, scripts, definition.text);
}

}  // namespace

DryRunSummary run_dry(const protocols::Protocol& protocol, const protocols::Definition& definition,
                      const DryRun& dry_run) {
  SessionRequest first;
  first.protocol = &protocol;
  first.definition = &definition;
  const int trials = dry_run.max_trials > 0 ? dry_run.max_trials : definition.design.trials;
  if (planned_sessions(definition, dry_run.participants, dry_run.session).empty()) {
    throw InputError(fmt::format("none of the first {} comes to session {}; give more --subjects",
                                 counted(dry_run.participants, "participant", "participants"),
                                 dry_run.session));
  }
  const double ticks_each = definition.rate * definition.longest(trials);
  if (dry_run.parts && dry_run.find_case) {
    throw InputError(
        "--parts shares sessions out, and those of a curriculum follow from each other; leave it "
        "out");
  }
  if (dry_run.parts) {
    DryParts parts(dry_run.folder, facts_of(definition, dry_run));
    take_plan(dry_run);
    return SessionWorkers(first, ticks_each, dry_run, &parts).run();
  }
  OutputFolder folder(dry_run.folder);
  take_plan(dry_run);
  if (dry_run.taught) {
    fs::create_directory(dry_run.folder / kTeaching);
  }
  if (dry_run.frames_per_pass > 0) {
    fs::create_directory(dry_run.folder / "frames");
  }
  try {
    const DryRunSummary summary = SessionWorkers(first, ticks_each, dry_run).run();
    folder.keep();
    return summary;
  } catch (const RunError& error) {
    throw RunError(fmt::format("{}\n{} is removed: a dry run is kept whole or not at all",
                               error.what(), dry_run.folder.string()));
  }
}

std::vector<PlannedSession> planned_sessions(const protocols::Definition& definition,
                                             int participants, int session) {
  std::vector<PlannedSession> all;
  for (int participant = 0; participant < participants; ++participant) {
    const std::string group = protocols::group_of(definition.groups, participant);
    for (int each = 1; each <= definition.sessions(); ++each) {
      if ((session == 0 || each == session) && definition.comes(each, group)) {
        all.push_back({participant, each});
      }
    }
  }
  return all;
}

std::string participant_name(int participant) { return fmt::format("S{:02}", participant + 1); }

std::vector<fs::path> session_files(const fs::path& folder) {
  std::error_code error;
  if (!fs::is_directory(folder, error)) {
    throw InputError(fmt::format("{}: {}; give a folder of session files", folder.string(),
                                 fs::exists(folder, error) ? "not a folder" : "no such folder"));
  }
  std::vector<fs::path> files;
  std::vector<std::string> unfinished;
  for (const auto& entry : fs::directory_iterator(folder, error)) {
    if (entry.path().extension() == ".h5") {
      files.push_back(entry.path());
    } else if (entry.path().extension() == ".partial") {
      unfinished.push_back(entry.path().filename().string());
    }
  }
  if (error) {
    throw InputError(fmt::format("{}: cannot be read ({})", folder.string(), error.message()));
  }
  if (files.empty() && !unfinished.empty()) {
    std::sort(unfinished.begin(), unfinished.end());
    throw InputError(fmt::format("{}: holds only unfinished sessions: {}; resume them",
                                 folder.string(), fmt::join(unfinished, ", ")));
  }
  if (files.empty()) {
    throw InputError(fmt::format("{}: holds no session file (.h5); give a folder with at least one",
                                 folder.string()));
  }
  std::sort(files.begin(), files.end());
  return files;
}

}  // namespace haptrial::experiments
