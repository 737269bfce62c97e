// Sessions: to run them, look into them, mend and show them; definitions and devices.
#include "experiments/command/line/command_lines.h"
#include "experiments/command/line/subcommand_internal.h"
#include "experiments/command/sessions/device_commands.h"
#include "experiments/command/sessions/session_commands.h"

namespace haptrial::experiments {

void add_dry_run(CLI::App& app, int& status) {
  CLI::App* sub =
      subcommand(app, "dry-run", "Run a whole study with virtual subjects, faster than real time",
                 "haptrial dry-run first_experiment --jobs 2",
                 {"a session file for each subject, for analyze", "guide-experimenter.md"});
  auto& o = options_of<DryRunOptions>(*sub, status, dry_run);
  sub->add_option("DEFINITION", o.definition, "Experiment definition (.toml)")->required();
  sub->add_option("--subjects", o.subjects,
                  "Number of virtual subjects (default: the participants of the definition)");
  sub->add_option("--seed", o.seed, "Seed of every random number (default: 1)");
  sub->add_option("--jobs", o.jobs, "Number of threads (default: one per processor)");
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
  sub->add_option("--frames", o.frames,
                  "Number of pictures to write of each pass, as the subject saw it (default: 0)");
  sub->add_option("--set", o.set,
                  "KEY=VALUE: a key of the definition that has another value, as a definition "
                  "writes it, such as observer.lapse=0.05; may be repeated")
      ->expected(1)
      ->take_all();
}

void add_run(CLI::App& app, int& status) {
  CLI::App* sub = subcommand(app, "run", "Run one participant's session in real time",
                             "haptrial run first_experiment --subject P01",
                             {"the session file ID.h5, for analyze", "guide-experimenter.md"});
  auto& o = options_of<RunOptions>(*sub, status, run);
  sub->add_option("DEFINITION", o.definition, "Experiment definition (.toml)")->required();
  sub->add_option("--subject", o.subject,
                  "Participant's identifier: letters, digits, '-', '_' (default: the next one of "
                  "the roster)");
  sub->add_option("--session", o.session,
                  "Number of the participant's session, of a study on several days (default: the "
                  "first that is left)");
  sub->add_option(
         "--device", o.devices,
         "Device: virtual, mouse, gamepad, force-dimension, open-haptics, replay:FILE or one "
         "of this program's own (default: virtual); repeated for each device of an experiment with "
         "several")
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
                  "Address of the console; needs --remote (default: 127.0.0.1)");
  sub->add_flag("--remote", o.remote, "Allow a console address that other machines can reach");
  sub->add_flag("--lsl", o.stream,
                "Stream to the Lab Streaming Layer; an error if its library is absent");
  sub->add_flag("--lsl-optional", o.stream_optional,
                "Stream to the Lab Streaming Layer if its library is present");
  sub->add_flag("--resume", o.resume, "Resume the participant's unfinished session");
  sub->add_option("--language", o.language,
                  "Language of what the participant reads, such as de (default: the definition's)");
  sub->add_flag("--pilot", o.pilot, "Mark the session as a pilot, which analyze leaves out");
  sub->add_option("--handedness", o.person.handedness, "Participant's handedness");
  sub->add_option("--age-band", o.person.age_band, "Participant's age band, such as 18-25");
  sub->add_option("--sex", o.person.sex, "Participant's sex");
  sub->add_option("--consent", o.person.consent_confirmed,
                  "Confirmation of consent, such as yes or a date");
  sub->add_option("--notes", o.person.notes, "Free text for the session file");
  sub->add_option("--seed", o.seed,
                  "Seed of the study, the same for all participants (default: 1)");
  sub->add_option("--participant", o.participant,
                  "Participant's number, for the order of conditions (default: the one that ends "
                  "the identifier)");
  sub->add_option("--trials", o.trials, "Number of trials, from the first (default: all)");
  sub->add_option("--out", o.out,
                  "Folder for the session file (default: out/sessions; with --teach out/teaching)");
}

void add_secret(CLI::App& app, int& status) {
  CLI::App* sub =
      subcommand(app, "secret", "Make the secret that two linked sessions share",
                 "haptrial secret tutoring.secret",
                 {"a file that only you may read; copy it to the other machine by a safe way",
                  "guide-experimenter.md"});
  auto& file = options_of<std::string>(*sub, status, make_secret);
  sub->add_option("FILE", file, "New file")->required();
}

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
  auto* exclude = sub->add_option("--exclude", o.exclude,
                                  "Participant whose files are moved into the folder excluded; the "
                                  "next new participant gets the place");
  auto* because = sub->add_option("--because", o.because, "Why, for excluded/reasons.csv");
  exclude->needs(because);
  because->needs(exclude);
}

void add_info(CLI::App& app, int& status) {
  CLI::App* sub =
      subcommand(app, "info", "Show what a session file holds and whether it is complete",
                 "haptrial info out/force_training-001/S01.h5", {"", "session-file.md"});
  auto& file = options_of<std::string>(*sub, status, info);
  sub->add_option("FILE", file, "Session file (.h5)")->required();
}

void add_recover(CLI::App& app, int& status) {
  struct Files {
    std::string damaged;
    std::string out;
  };
  CLI::App* sub = subcommand(app, "recover", "Save what a damaged session file still holds",
                             "haptrial recover out/sessions/P01.h5.partial",
                             {"a session file of what could be read", "session-file.md"});
  auto& o =
      options_of<Files>(*sub, status, [](const Files& f) { return recover(f.damaged, f.out); });
  sub->add_option("FILE", o.damaged,
                  "Damaged session file (.h5, .partial), which is left unchanged")
      ->required();
  sub->add_option("OUT", o.out, "New session file (default: S01.recovered.h5 for S01.h5)");
}

void add_replay(CLI::App& app, int& status) {
  CLI::App* sub =
      subcommand(app, "replay",
                 "Replay a recorded trial as the participant saw it, or simulate a drilling again",
                 "haptrial replay out/force_training-001/S01.h5 --trial 3 --video trial-3.mp4",
                 {"the video, pictures or sound asked for", "guide-analyst.md"});
  auto& o = options_of<ReplayOptions>(*sub, status, replay);
  sub->add_option("FILE", o.file, "Session file (.h5)")->required();
  sub->add_option("--trial", o.trial,
                  "Number of the trial, from 1 (default: of a drilling all, in a video the first)");
  sub->add_option("--phase", o.phase, "Phase of the trial: training or test (default: both)");
  sub->add_option("--video", o.video, "New video (.mp4); needs ffmpeg");
  sub->add_option("--frames", o.frames, "New folder for pictures (.png)");
  sub->add_option("--sound", o.sound, "New sound file of a drilling (.wav)");
  sub->add_option("--fps", o.fps, "Pictures per second [1/s] (default: 30)");
}

void add_validate(CLI::App& app, int& status) {
  CLI::App* sub = subcommand(app, "validate", "Check a definition and show the study that it plans",
                             "haptrial validate first_experiment", {"", "guide-experimenter.md"});
  auto& definition = options_of<std::string>(*sub, status, validate);
  sub->add_option("DEFINITION", definition, "Experiment definition (.toml)")->required();
}

void add_devices(CLI::App& app, int& status) {
  CLI::App* sub = subcommand(app, "devices", "List the devices and how to use them",
                             "haptrial devices", {"", "devices.md"});
  sub->callback([&status] { status = devices(); });
}

void add_device_test(CLI::App& app, int& status) {
  CLI::App* sub = subcommand(app, "device-test", "Check whether a device is fit for experiments",
                             "haptrial device-test force-dimension", {"", "devices.md"});
  auto& o = options_of<DeviceTestOptions>(*sub, status, device_test);
  sub->add_option(
         "NAME", o.name,
         "Device: virtual, mouse, force-dimension, open-haptics or one of this program's own")
      ->required();
  sub->add_option(
      "--definition", o.definition,
      "Definition whose set-up of the device is checked (.toml) (default: the driver's own)");
  sub->add_option("--seconds", o.seconds, "Duration [s] (default: 120)");
  sub->add_option("--library", o.library,
                  "Path of the vendor's library (default: found by the system)");
}

}  // namespace haptrial::experiments
