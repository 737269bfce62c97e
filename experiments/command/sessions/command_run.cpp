#include <fmt/format.h>
#include <fmt/ranges.h>

#include <unistd.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <map>
#include <memory>
#include <set>

#include "core/base/counted.h"
#include "core/base/error.h"
#include "core/device/registered_devices.h"
#include "core/record/hdf5/session_target.h"
#include "core/record/read/session_facts.h"
#include "core/record/recovery/session_resume.h"
#include "core/stream/lsl_outlet.h"
#include "experiments/command/arguments.h"
#include "experiments/command/sessions/meet_partner.h"
#include "experiments/command/sessions/next_session.h"
#include "experiments/command/sessions/run_checks.h"
#include "experiments/command/sessions/run_options.h"
#include "experiments/command/sessions/session_checks.h"
#include "experiments/command/subcommand.h"
#include "experiments/console/console.h"
#include "experiments/control/keyboard.h"
#include "experiments/control/signals.h"
#include "experiments/plan/study_plan.h"
#include "experiments/runner/session.h"
#include "experiments/studies/experiment.h"
#include "experiments/study/backup.h"
#include "experiments/study/session_name.h"
#include "protocols/definition/button_uses.h"
#include "protocols/definition/mirroring.h"

namespace haptrial::experiments {
namespace fs = std::filesystem;
namespace {

/// Several devices of one vendor are told apart by their order.
void choose_devices(const RunOptions& options, SessionRequest& request) {
  std::map<std::string, int> seen;
  std::vector<DeviceChoice> choices;
  for (const std::string& device : options.devices) {
    choices.push_back({device, takes_library(device) ? options.library : "", seen[device]++});
  }
  request.device = choices.front();
  request.more_devices.assign(choices.begin() + 1, choices.end());
}

int participant_of(const RunOptions& options) {
  constexpr int kMost = 10000;
  if (options.participant) {
    return checked_number("--participant", *options.participant, 1, kMost) - 1;
  }
  const int number = number_of_subject(options.subject);
  if (number == 0) {
    throw InputError(
        fmt::format("--subject '{}' does not end in a number from 1 to {}, so the order of "
                    "conditions is not known; add --participant NUMBER",
                    options.subject, kMost));
  }
  return number - 1;
}

/// Before anything moves or is recorded.
void require_streams() {
  try {
    stream::LslOutlet::check_library();
  } catch (const InputError& error) {
    throw InputError(
        fmt::format("{}; --lsl-optional runs the session without streams", error.what()));
  }
}

/// With an experimenter at the console's page or at the keyboard, where that was asked for.
SessionSummary attended_session(SessionRequest& request, const RunOptions& options) {
  if (!options.console && !options.keyboard) {
    return run_session(request);
  }
  SessionControl control;  // outlives what speaks to it
  request.control = &control;
  std::unique_ptr<Console> console;
  if (options.console) {
    ConsoleOptions console_options;
    console_options.address = options.address.value_or(console_options.address);
    console_options.port = checked_number("--port", options.port.value_or(0), 0, 65535);
    console_options.allow_remote = options.remote;
    console_options.watch_address = options.watch;
    console_options.on_refusal = [&control](const std::string& sentence) {
      control.note("console: " + sentence);
    };
    console_options.sides = request.auxiliary_pages;
    console_options.terminal = Keyboard::can_read();
    console = std::make_unique<Console>(control, console_options);
    fmt::print("console: {}\n", console->url());
    if (!options.watch.empty()) {
      fmt::print("watch: {}\n", console->watch_url());
    }
    for (const auto& side : request.auxiliary_pages) {
      fmt::print("{}: {}\n", side->title(), console->side_url(side->name()));
    }
    std::fflush(stdout);
  }
  const Keyboard keyboard(control);
  if (!console && !keyboard.active()) {
    throw InputError(
        "--keyboard needs a terminal with this program in its foreground, or nobody could clear a "
        "stop; add --console, or run it in a terminal");
  }
  if (keyboard.active()) {
    fmt::print("{}\n", Keyboard::help());
    std::fflush(stdout);
  }
  return run_session(request);
}

/// Those of the definition's pages that are to be served.
protocols::AuxiliaryPages chosen_pages(const RunOptions& options,
                                       const protocols::Protocol& protocol,
                                       const protocols::Definition& definition) {
  const protocols::AuxiliaryPages all = protocol.auxiliary_pages(definition);
  std::vector<std::string> offered;
  for (const auto& side : all) {
    offered.emplace_back(side->name());
  }
  protocols::AuxiliaryPages chosen;
  for (const std::string& name :
       std::set(options.auxiliary_pages.begin(), options.auxiliary_pages.end())) {
    const auto found = std::find(offered.begin(), offered.end(), name);
    if (found == offered.end()) {
      throw InputError(fmt::format("--side-page: {} has no page '{}'; {}", options.definition, name,
                                   offered.empty()
                                       ? "it has none beside the console's"
                                       : fmt::format("it has {}", fmt::join(offered, ", "))));
    }
    chosen.push_back(all[static_cast<std::size_t>(found - offered.begin())]);
    if (chosen.back()->is_for_pilots() && !options.pilot) {
      throw InputError(fmt::format(
          "--side-page {} changes the definition while somebody works, which no session of a study "
          "may; add --pilot",
          name));
    }
  }
  if (!chosen.empty() && !options.console) {
    throw InputError("--side-page needs --console, which serves the page");
  }
  return chosen;
}

/// A session that is resumed has the hand that it began with, if no other is given.
std::string handedness_of(const RunOptions& options, const fs::path& file) {
  if (!options.resume || !options.person.handedness.empty()) {
    return options.person.handedness;
  }
  return record::read_unfinished(record::partial_path(file)).info.participant.handedness;
}

/// A virtual participant has no better hand, and a recording's was mirrored when it was recorded.
bool has_better_hand(const std::string& device) {
  return device != "virtual" && !replayed_file(device);
}

/// Copies the file of an ended session, if the room or the command line has a folder for it.
void keep_backup(const RunOptions& options, const protocols::Definition& setup,
                 const fs::path& file) {
  const std::string folder = backup_folder(options, setup);
  if (folder.empty()) {
    return;
  }
  const BackupResult result = try_back_up(file, folder, setup.name);
  fmt::print(result.kept ? stdout : stderr, "{}\n", result.sentence);
  std::fflush(stdout);
}

/// Says that a study which may end early has ended, unless the checklist has said it.
void warn_of_ended_study(const RunOptions& options, const Experiment& experiment) {
  const auto end = options.checked ? std::nullopt : check_end_of_study(options, experiment);
  if (end && end->state == MachineCheck::State::kLimited) {
    fmt::print("warning: {}\n", end->found);
    std::fflush(stdout);
  }
}

}  // namespace

RunEnd run_command(const RunOptions& asked) {
  watch_for_interrupt();
  watch_fatal_signals();
  RunOptions options = asked;
  options.out = session_folder(options);
  check_run_options(options);
  if (::isatty(STDERR_FILENO) != 0) {
    fmt::print(stderr, "preparing {}\n", options.definition);  // bones take seconds
  }
  Experiment experiment =
      load_experiment(options.definition, options.language, given_keys(options.set));
  if (const std::string chosen = choose_session(options, experiment); !chosen.empty()) {
    fmt::print("{}\n", chosen);
    std::fflush(stdout);
  }
  if (const std::string language = begun_language(options, *experiment.definition);
      !language.empty()) {
    fmt::print("language {}, in which the session began\n", language);
    options.language = language;
    experiment = load_experiment(options.definition, options.language, given_keys(options.set));
  }
  warn_of_ended_study(options, experiment);
  if (!options.case_name.empty()) {
    experiment.definition =
        experiment.study->protocol().of_case(*experiment.definition, options.case_name);
  }
  const protocols::Definition& setup = *experiment.definition;
  options.seed = session_seed(options, session_file(options, setup));
  check_recording(options, experiment.study->protocol(), setup);
  check_pages(options, setup);
  for (const std::string& sentence : protocols::button_warnings(setup, options.devices)) {
    fmt::print("warning: {}\n", sentence);
  }
  const protocols::AuxiliaryPages auxiliary_pages =
      chosen_pages(options, experiment.study->protocol(), setup);
  if (!experiment.untranslated.empty()) {
    fmt::print(
        "language {}: {} shown as the definition has them; haptrial validate lists them\n",
        options.language,
        counted(experiment.untranslated.size(), "text is missing and", "texts are missing and"));
  }
  if (options.window) {
    for (const std::string& sentence : undrawable_texts(experiment)) {
      fmt::print("warning: {}\n", sentence);
    }
  }
  if (options.stream && !options.stream_optional) {
    require_streams();
  }
  SessionRequest request;
  request.protocol = &experiment.study->protocol();
  request.definition = experiment.definition.get();
  request.live = [&experiment](const fs::path& resumed) {
    return experiment.study->live_figures(*experiment.definition, resumed);
  };
  request.definition_folder = fs::path(options.definition).parent_path();
  request.subject = options.subject;
  request.participant = participant_of(options);
  request.seed = checked_seed(options.seed);
  request.clock = realtime::ClockKind::kReal;
  request.max_trials =
      options.trials ? checked_number("--trials", *options.trials, 1, setup.design.trials) : 0;
  request.session = options.session.value_or(1);
  if (!options.tutor.empty()) {
    request.tutor = checked_tutor(options.tutor, experiment.study->protocol());
  }
  request.file = session_file(options, setup);
  check_session_file(options, request.file);
  options.person.handedness = handedness_of(options, request.file);
  if (has_better_hand(options.devices.front())) {
    protocols::mirror_for(options.person.handedness, *experiment.definition);
  }
  if (!options.resume) {
    if (const std::string changed =
            check_study(options, experiment.study->protocol(), setup, request.file);
        !changed.empty()) {
      fmt::print("{}\n", changed);
    }
  }
  request.link = meet_partner(options, request, setup);
  std::error_code error;
  fs::create_directories(options.out, error);
  if (error) {
    throw InputError(
        fmt::format("{}: the folder cannot be created ({})", options.out, error.message()));
  }
  adopt_plan(options.definition, options.out);
  choose_devices(options, request);
  request.auxiliary_pages = auxiliary_pages;
  request.window = options.window;
  request.stream = options.stream || options.stream_optional;
  request.stream_optional = options.stream_optional;
  const bool over_status = ::isatty(STDOUT_FILENO) != 0;  // which has no end of line
  request.tell = [over_status](const std::string& line) {
    fmt::print("{}{}\n", over_status ? "\r\x1b[K" : "", line);
    std::fflush(stdout);  // it may be a file that somebody follows
  };
  request.resume = options.resume;
  request.pilot = options.pilot;
  request.person = options.person;
  request.person.identifier = options.subject;
  const SessionSummary done = attended_session(request, options);
  for (const record::LiveState& trial : done.figures) {
    fmt::print("{}{}\n", done.simulated ? "SIMULATED " : "", trial.line);
  }
  fmt::print("session: {}{}\n", request.file.string(), done.stopped ? ".partial" : "");
  if (done.stopped) {
    fmt::print("stopped with trials left; the same command with --resume continues with them\n");
  }
  if (!done.stopped) {
    keep_backup(options, setup, request.file);
    for (const std::string& line : experiment.study->after_session(
             setup, fs::path(options.definition).parent_path(), request.file)) {
      fmt::print("{}\n", line);
    }
  }
  fmt::print("{} ticks at {} Hz, {}, {}, {} aborted\n", done.ticks, setup.rate,
             counted(done.overruns, "overrun", "overruns"),
             counted(done.dropped, "lost record", "lost records"),
             counted(done.aborted_passes, "pass", "passes"));
  for (const std::string& line : done.markers) {
    fmt::print("markers, {}\n", line);
  }
  if (const auto late = record::too_many_overruns(done.ticks, done.overruns)) {
    fmt::print("WARNING: the servo loop did not keep its rate: {}\n", *late);
  }
  return {request.file, options.subject, done.stopped};
}

void add_run(CLI::App& app, int& status) {
  CLI::App* sub = subcommand(app, "run", "Run one participant's session in real time",
                             "haptrial run first_experiment --subject P01",
                             {"the session file ID.h5, for analyze", "guide-experimenter.md"});
  auto& options = options_of<RunOptions>(*sub, status, [](const RunOptions& asked) {
    run_command(asked);
    return 0;
  });
  declare_run_options(*sub, options);
}

void declare_run_options(CLI::App& app, RunOptions& o) {
  CLI::App* sub = &app;
  sub->add_option("DEFINITION", o.definition, "Experiment definition (.toml)")->required();
  sub->add_option("--subject", o.subject,
                  "Participant's identifier: letters, digits, '-', '_' (default: the next one of "
                  "the roster)");
  sub->add_option("--session", o.session,
                  "Number of the participant's session, of a study on several days (default: the "
                  "first that is left)");
  sub->add_option("--case", o.case_name,
                  "Case of the definition's curriculum (default: the one that comes next)");
  sub->add_option("--device", o.devices,
                  with_default(fmt::format("Device: {} or replay:FILE",
                                           fmt::join(device::device_names(), ", ")),
                               o.devices.front()) +
                      "; repeated for each device of an experiment with several")
      ->allow_extra_args(false);
  sub->add_option("--library", o.library,
                  "Path of the vendor's library (default: found by the system)");
  sub->add_option("--tutor", o.tutor,
                  "Recorded run that leads the hand: FILE, FILE:TRIAL or FILE:TRIAL@SECONDS");
  sub->add_option("--teach", o.teach,
                  "Port at which another machine's session is awaited, whose hand is led");
  sub->add_option("--learn-from", o.learn_from,
                  "HOST:PORT of the session whose hand leads, started there with --teach");
  sub->add_option("--secret", o.secret,
                  "File of the secret that both sides have (haptrial secret FILE)");
  sub->add_flag("--window", o.window, "Show the participant's screen");
  sub->add_flag("--keyboard", o.keyboard, "Control the session with this terminal's keys");
  sub->add_flag("--console", o.console, "Serve the experimenter's page on the loopback address");
  sub->add_option("--side-page", o.auxiliary_pages,
                  "Name of a page to serve beside the console; repeated for each page (haptrial "
                  "validate lists those of a definition)")
      ->allow_extra_args(false);
  sub->add_option("--port", o.port, "Port of the console (default: any free port)");
  sub->add_option("--address", o.address,
                  with_default("Address of the console; needs --remote", ConsoleOptions{}.address));
  sub->add_flag("--remote", o.remote, "Allow a console address that other machines can reach");
  sub->add_option("--watch", o.watch,
                  "Serve beside the console a copy of it that only looks, for a phone, at this "
                  "address of a network interface: whoever has the printed address sees the "
                  "participant's identifier, questions, answers and forces, sent unencrypted, and "
                  "can change nothing");
  sub->add_flag("--lsl", o.stream,
                "Stream to the Lab Streaming Layer; an error if its library is absent");
  sub->add_flag("--lsl-optional", o.stream_optional,
                "Stream to the Lab Streaming Layer if its library is present");
  sub->add_flag("--resume", o.resume, "Resume the participant's unfinished session");
  sub->add_option("--language", o.language,
                  "Language of what the participant reads, such as de (default: the definition's)");
  sub->add_flag("--pilot", o.pilot, "Mark the session as a pilot, which analyze leaves out");
  declare_set_option(*sub, o.set);
  sub->add_option("--handedness", o.person.handedness,
                  "Participant's handedness: left, right, or both (ambidextrous)");
  sub->add_option("--age-band", o.person.age_band, "Participant's age band, such as 18-25");
  sub->add_option("--sex", o.person.sex, "Participant's sex");
  sub->add_option("--consent", o.person.consent_confirmed,
                  "Confirmation of consent, such as yes or a date");
  sub->add_option("--notes", o.person.notes, "Free text for the session file");
  sub->add_option("--seed", o.seed,
                  "Seed of the study, the same for all participants (default: that of the sessions "
                  "in the folder; 1 if there are none)");
  sub->add_option("--participant", o.participant,
                  "Participant's number, for the order of conditions (default: that of the "
                  "participant's earlier sessions, or the one that ends the identifier)");
  sub->add_option("--trials", o.trials, "Number of trials, from the first (default: all)");
  RunOptions teaching;
  teaching.teach = 1;
  sub->add_option("--out", o.out,
                  fmt::format("Folder for the session file (default: {}; with --teach {})",
                              session_folder({}), session_folder(teaching)));
  sub->add_option("--backup", o.backup,
                  "Folder on another disk for a copy of the ended session (default: backup of "
                  "[room])");
}

}  // namespace haptrial::experiments
