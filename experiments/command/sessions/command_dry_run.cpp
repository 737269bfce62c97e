#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <filesystem>
#include <optional>
#include <utility>
#include <vector>

#include "core/base/counted.h"
#include "core/base/error.h"
#include "core/record/read/session_reader.h"
#include "experiments/command/arguments.h"
#include "experiments/command/sessions/next_session.h"
#include "experiments/command/sessions/run_checks.h"
#include "experiments/command/sessions/run_options.h"
#include "experiments/command/subcommand.h"
#include "experiments/control/signals.h"
#include "experiments/studies/experiment.h"
#include "experiments/study/session_name.h"
#include "experiments/study/session_times.h"
#include "experiments/study/shared_work.h"
#include "experiments/study/study_run.h"

namespace haptrial::experiments {
namespace fs = std::filesystem;
namespace {

struct DryRunOptions {
  std::string definition;
  std::optional<int> subjects;
  std::string seed{"1"};
  std::optional<int> jobs;
  std::string out;
  std::string parts;
  int frames{0};
  std::optional<int> trials;
  std::optional<int> session;
  std::string tutor;
  bool taught{false};
  std::string language;
  std::optional<double> setup;
  std::vector<std::string> set{};
};

/// out/NAME-001, or the next number that is free.
fs::path fresh_folder(const std::string& name) {
  for (int n = 1;; ++n) {
    const fs::path folder = fs::path("out") / fmt::format("{}-{:03}", name, n);
    if (!fs::exists(folder)) {
      return folder;
    }
  }
}

/// Takes --parts, and the rank of a process that mpirun or srun started. @returns the rank
int take_parts(const DryRunOptions& options, DryRun& dry) {
  if (options.parts.empty()) {
    return 0;
  }
  for (const auto& [name, given] :
       {std::pair{"--out", !options.out.empty()}, std::pair{"--frames", options.frames > 0},
        std::pair{"--tutor", !options.tutor.empty()}, std::pair{"--taught", options.taught}}) {
    if (given) {
      throw InputError(fmt::format("{} is given together with --parts; leave it out", name));
    }
  }
  dry.parts = true;
  dry.folder = options.parts;
  const std::optional<LaunchRank> rank = launch_rank();
  if (!rank) {
    return 0;
  }
  dry.jobs = options.jobs.value_or(1);
  dry.start = static_cast<double>(rank->rank) / rank->size;
  return rank->rank;
}

/// run_dry(), whose interrupt says what is left and how more would be.
static DryRunSummary run_until_interrupt(const protocols::Protocol& protocol,
                                         const protocols::Definition& setup, const DryRun& dry) {
  try {
    return run_dry(protocol, setup, dry);
  } catch (const RunError&) {
    if (!interrupted()) {
      throw;
    }
    throw RunError(
        dry.parts ? fmt::format("interrupted; finished sessions stay in {}, and the same command "
                                "runs those that are missing",
                                dry.folder.string())
                  : "interrupted; no session is kept. With --parts FOLDER finished ones are kept");
  }
}

/// "the first since trial 1: a stage was not done in time: approach, 2 mm from the region start".
static std::string first_abort(const fs::path& session) {
  for (const record::EventRow& event : record::SessionReader(session).events()) {
    if (event.kind == "aborted") {
      return "the first since " + event.text;
    }
  }
  return "without a reason";
}

/// Sentence about the folder with pictures; an empty one is removed.
static std::string pictures_in(const fs::path& folder) {
  const fs::path frames = folder / "frames";
  if (!fs::is_empty(frames)) {
    return frames.string();
  }
  fs::remove(frames);
  return "none, since a dry run of this protocol draws none; haptrial replay FILE --frames FOLDER "
         "does";
}

/// Says how many hours in the lab the whole study takes, if sessions last as in this rehearsal.
static void print_lab_time(const protocols::Definition& d, const fs::path& folder,
                           std::optional<double> setup) {
  if (const auto times = session_times(session_files(folder), d)) {
    const auto all = static_cast<int>(planned_sessions(d, d.design.participants).size());
    fmt::print("lab time: {}; pages not counted\n", lab_time(*times, all, setup));
  }
}

int dry_run(const DryRunOptions& options) {
  watch_for_interrupt();
  const Experiment experiment =
      load_experiment(options.definition, options.language, given_keys(options.set));
  const protocols::Definition& setup = *experiment.definition;
  DryRun dry;
  dry.participants =
      checked_number("--subjects", options.subjects.value_or(setup.design.participants), 1, 10000);
  dry.definition = options.definition;
  dry.seed = checked_seed(options.seed);
  dry.jobs = checked_jobs(options.jobs);
  const std::optional<double> between = checked_setup(options.setup);
  dry.frames_per_pass = checked_number("--frames", options.frames, 0, 1000);
  dry.max_trials =
      options.trials ? checked_number("--trials", *options.trials, 1, setup.design.trials) : 0;
  dry.session = options.session ? checked_session(*options.session, setup) : 0;
  if (!options.tutor.empty()) {
    dry.tutor = checked_tutor(options.tutor, experiment.study->protocol());
  }
  if (options.taught && !options.tutor.empty()) {
    throw InputError("--tutor and --taught are both given; leave out one of them");
  }
  dry.taught = options.taught;
  dry.find_case = find_case_of(experiment, options.definition);
  const int rank = take_parts(options, dry);
  if (interrupted()) {  // while the definition was read, which makes its bones
    throw RunError("interrupted; no session was begun");
  }
  if (!dry.parts) {
    dry.folder = options.out.empty() ? fresh_folder(setup.name) : fs::path(options.out);
  }
  print_warnings(experiment);
  for (const std::string& sentence : experiment.untranslated) {
    fmt::print("{}\n", sentence);
  }
  for (const std::string& line : setup.left_out_of_dry_runs()) {
    fmt::print("{}\n", line);
  }
  if (!setup.tutoring.led.groups.empty() && !dry.tutor && !dry.taught) {
    fmt::print("nobody is led, though tutoring.led_in names groups: add --tutor FILE:TRIAL\n");
  }
  const DryRunSummary done = run_until_interrupt(experiment.study->protocol(), setup, dry);
  if (rank > 0) {
    return 0;  // the first of them reports
  }
  fmt::print("{}, {:.0f} s of simulated time in {:.1f} s ({:.0f} times real time)\n",
             counted(done.sessions, "session", "sessions"), done.recorded_seconds,
             done.elapsed_seconds, done.recorded_seconds / done.elapsed_seconds);
  if (done.passes == 0 && done.sessions > 0) {
    throw RunError("no trial was presented: the procedures were finished before their first one");
  }
  if (done.aborted_passes == done.passes && done.sessions > 0) {
    const fs::path first =
        dry.folder / session_file_name("S01", std::max(1, dry.session), setup.sessions());
    throw RunError(fmt::format("every pass was aborted, {}; haptrial info {} says more",
                               first_abort(first), first.string()));
  }
  if (done.aborted_passes > 0) {
    fmt::print("{}; haptrial info FILE says which and why\n",
               counted(done.aborted_passes, "pass was aborted", "passes were aborted"));
  }
  if (done.given_up > 0) {
    fmt::print(stderr, "warning: {} with trials left, since too many were not completed\n",
               counted(done.given_up, "session ended", "sessions ended"));
  }
  for (const fs::path& file : session_files(dry.folder)) {
    for (const std::string& line :
         experiment.study->after_session(setup, fs::path(options.definition).parent_path(), file)) {
      fmt::print("{}\n", line);
    }
  }
  if (dry.max_trials == 0 && dry.session == 0) {
    print_lab_time(setup, dry.folder, between);
  }
  if (dry.frames_per_pass > 0) {
    fmt::print("pictures: {}\n", pictures_in(dry.folder));
  }
  fmt::print("sessions: {}\n", dry.folder.string());
  fmt::print("next: {}\n", experiment.study->next_step(dry.folder));
  return 0;
}

}  // namespace

void add_dry_run(CLI::App& app, int& status) {
  CLI::App* sub =
      subcommand(app, "dry-run", "Run a whole study with virtual subjects, faster than real time",
                 "haptrial dry-run first_experiment --jobs 2",
                 {"a session file for each subject, for analyze", "guide-experimenter.md"});
  auto& o = options_of<DryRunOptions>(*sub, status, dry_run);
  sub->add_option("DEFINITION", o.definition, "Experiment definition (.toml)")->required();
  sub->add_option("--subjects", o.subjects,
                  "Number of virtual subjects (default: the participants of the definition)");
  sub->add_option("--seed", o.seed, with_default("Seed of every random number", o.seed));
  sub->add_option("--jobs", o.jobs, kJobsHelp);
  sub->add_option("--out", o.out, "New folder for the session files (default: out/NAME-001)");
  sub->add_option("--parts", o.parts,
                  "Folder of session files, in place of --out: the same command again, or several "
                  "at once, run the sessions that are missing");
  sub->add_option("--trials", o.trials,
                  "Number of trials of each session, from the first (default: all)");
  sub->add_option(
      "--session", o.session,
      "Number of the one session of each subject to run (default: all, in their order)");
  sub->add_option("--language", o.language,
                  "Language of what participants read, such as de (default: the definition's)");
  sub->add_option("--tutor", o.tutor,
                  "Recorded run that leads the hand: FILE, FILE:TRIAL or FILE:TRIAL@SECONDS");
  sub->add_flag("--taught", o.taught,
                "Lead each participant by a second virtual one, over a simulated network");
  sub->add_option(
      "--frames", o.frames,
      with_default("Number of pictures to write of each pass, as the subject saw it", o.frames));
  sub->add_option("--setup", o.setup,
                  "Minutes in the lab between two sessions, for the lab time of the whole study");
  declare_set_option(*sub, o.set);
}

}  // namespace haptrial::experiments
