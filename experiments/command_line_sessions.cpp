// Sessions: to run them, look into them, mend and show them; definitions and devices.
#include "experiments/command_line_internal.h"

namespace haptrial::experiments {

void add_dry_run(CLI::App& app, int& status) {
  CLI::App* sub =
      subcommand(app, "dry-run", "Run a study with virtual subjects, as fast as it goes",
                 "haptrial dry-run experiments/force_training.toml --jobs 2");
  auto& o = options_of<DryRunOptions>(*sub, status, dry_run);
  sub->add_option("DEFINITION", o.definition, "Experiment definition (.toml)")->required();
  sub->add_option("--subjects", o.subjects, "How many; as the definition says by default");
  sub->add_option("--seed", o.seed, "Of every random number (1)");
  sub->add_option("--jobs", o.jobs, "Threads; one per processor by default");
  sub->add_option("--out", o.out, "New folder for the session files (out/NAME-001)");
  sub->add_option("--trials", o.trials, "Only the first so many of each subject");
  sub->add_option("--frames", o.frames,
                  "Also write so many pictures of each pass, as the subject saw it (0)");
}

void add_run(CLI::App& app, int& status) {
  CLI::App* sub = subcommand(app, "run", "Run one participant's session in real time",
                             "haptrial run experiments/force_training.toml --subject P01");
  auto& o = options_of<RunOptions>(*sub, status, run);
  sub->add_option("DEFINITION", o.definition, "Experiment definition (.toml)")->required();
  sub->add_option("--subject", o.subject, "Identifier: letters, digits, '-', '_'")->required();
  sub->add_option("--device", o.device,
                  "virtual, mouse, force-dimension, open-haptics or replay:FILE (virtual)");
  sub->add_option("--library", o.library, "Path of the vendor's library; searched for by default");
  sub->add_flag("--window", o.window, "Show the participant's screen");
  sub->add_flag("--keyboard", o.keyboard, "Keys of this terminal steer the session");
  sub->add_flag("--console", o.console, "Serve the experimenter's page on the loopback address");
  sub->add_option("--port", o.port, "Of the console (any that is free)");
  sub->add_option("--address", o.address, "Of the console (127.0.0.1); needs --remote");
  sub->add_flag("--remote", o.remote, "Let the console listen on another address");
  sub->add_flag("--lsl", o.stream,
                "Stream to the Lab Streaming Layer; refused when its library is absent");
  sub->add_flag("--lsl-optional", o.stream_optional,
                "Likewise, but go on without streams when the library is absent");
  sub->add_flag("--resume", o.resume, "Go on with the session that did not come to its end");
  sub->add_flag("--pilot", o.pilot, "No part of the study: analyze leaves the session out");
  sub->add_option("--handedness", o.person.handedness, "Of the participant, for the file");
  sub->add_option("--age-band", o.person.age_band, "Such as 18-25");
  sub->add_option("--sex", o.person.sex, "Of the participant, for the file");
  sub->add_option("--consent", o.person.consent_confirmed, "Such as yes, or a date");
  sub->add_option("--notes", o.person.notes, "Free text, for the file");
  sub->add_option("--seed", o.seed, "Of the study (1)");
  sub->add_option("--participant", o.participant,
                  "Number that sets the order of conditions; at the end of ID by default");
  sub->add_option("--trials", o.trials, "Only the first so many");
  sub->add_option("--out", o.out, "Folder for the session file (out/sessions)");
}

void add_info(CLI::App& app, int& status) {
  CLI::App* sub =
      subcommand(app, "info", "Say what a session file holds and whether it is complete",
                 "haptrial info out/force_training-001/S01.h5");
  auto& file = options_of<std::string>(*sub, status, info);
  sub->add_option("FILE", file, "Session file (.h5)")->required();
}

void add_recover(CLI::App& app, int& status) {
  struct Files {
    std::string damaged;
    std::string out;
  };
  CLI::App* sub = subcommand(app, "recover", "Save what a damaged session file still holds",
                             "haptrial recover out/sessions/P01.h5.partial");
  auto& o =
      options_of<Files>(*sub, status, [](const Files& f) { return recover(f.damaged, f.out); });
  sub->add_option("FILE", o.damaged, "Damaged session file (.h5, .partial); it stays as it is")
      ->required();
  sub->add_option("OUT", o.out, "New session file (FILE.recovered.h5)");
}

void add_replay(CLI::App& app, int& status) {
  CLI::App* sub = subcommand(
      app, "replay", "Show a recorded trial as the participant saw it; drill a bone again",
      "haptrial replay out/force_training-001/S01.h5 --trial 3 --video trial-3.mp4");
  auto& o = options_of<ReplayOptions>(*sub, status, replay);
  sub->add_option("FILE", o.file, "Session file (.h5)")->required();
  sub->add_option("--trial", o.trial,
                  "Number from 1; of a drilling all by default, and the first for a video");
  sub->add_option("--phase", o.phase, "training or test; both by default");
  sub->add_option("--video", o.video, "New video (.mp4), written by ffmpeg");
  sub->add_option("--frames", o.frames, "New folder for pictures (.png)");
  sub->add_option("--sound", o.sound, "New sound of a drilling (.wav)");
  sub->add_option("--fps", o.fps, "Pictures a second (30)");
}

void add_validate(CLI::App& app, int& status) {
  CLI::App* sub = subcommand(app, "validate", "Check a definition and say what it plans",
                             "haptrial validate experiments/force_training.toml");
  auto& definition = options_of<std::string>(*sub, status, validate);
  sub->add_option("DEFINITION", definition, "Experiment definition (.toml)")->required();
}

void add_devices(CLI::App& app, int& status) {
  CLI::App* sub = subcommand(app, "devices", "List the devices", "haptrial devices");
  sub->callback([&status] { status = devices(); });
}

void add_device_test(CLI::App& app, int& status) {
  CLI::App* sub = subcommand(app, "device-test", "Check a device and say whether it is fit",
                             "haptrial device-test force-dimension");
  auto& o = options_of<DeviceTestOptions>(*sub, status, device_test);
  sub->add_option("NAME", o.name, "virtual, mouse, force-dimension or open-haptics")->required();
  sub->add_option("--definition", o.definition,
                  "Set the device up as this experiment does (.toml)");
  sub->add_option("--seconds", o.seconds, "How long (120)");
  sub->add_option("--library", o.library, "Path of the vendor's library; searched for by default");
}

}  // namespace haptrial::experiments
