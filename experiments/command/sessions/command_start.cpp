#include <fmt/chrono.h>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cctype>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <ctime>
#include <filesystem>
#include <limits>
#include <memory>
#include <nlohmann/json.hpp>
#include <numbers>
#include <set>
#include <string>
#include <thread>
#include <vector>

#include "analysis/document/document.h"
#include "core/base/definition/table.h"
#include "core/base/error.h"
#include "core/base/exception_words.h"
#include "core/base/shell_word.h"
#include "core/base/whole_file.h"
#include "core/device/handle_part.h"
#include "core/device/vendor_devices.h"
#include "core/sound/card_player.h"
#include "experiments/command/sessions/confirmation.h"
#include "experiments/command/sessions/run_checks.h"
#include "experiments/command/sessions/run_options.h"
#include "experiments/command/sessions/session_checks.h"
#include "experiments/command/subcommand.h"
#include "experiments/control/keyboard.h"
#include "experiments/runner/version.h"
#include "experiments/studies/experiment.h"
#include "protocols/definition/button_uses.h"
#include "protocols/definition/room.h"

namespace haptrial::experiments {
namespace {

namespace fs = std::filesystem;
using analysis::Document;
using protocols::Definition;

struct StartOptions : RunOptions {
  bool check{false};
  bool json{false};
  std::string card;
  std::string session_words;  // " --window": as they were given, without those of a participant
};

/// The most that a device gives with a part of its handle, as far as its driver's table says so, at
/// the fingers [N].
double driver_limit(const std::string& device, const protocols::DeviceArm& arm,
                    const Definition& d) {
  const device::VendorDevice* const vendor = device::vendor_device(device);
  if (vendor == nullptr) {
    return std::numeric_limits<double>::infinity();
  }
  const device::VendorDevice::Limits limits = vendor->limits(d.vendor);
  device::DeviceInfo info;
  info.max_force = limits.max_force;
  info.max_torque = limits.max_torque;
  info.max_grip_force = limits.max_grip_force;
  return device::most_force(arm.part, info, arm.radius);
}

bool is_tip(const protocols::DeviceArm& arm) { return arm.part == device::Part::kTip; }

/// The greatest force that a session may command with each part of the handles, in its unit:
/// "0.2 N·m (knob, rotation)".
std::vector<std::string> greatest_forces(const RunOptions& options, const Definition& d) {
  const std::vector<protocols::DeviceArm> arms = d.arms();
  std::vector<std::string> forces;
  for (std::size_t i = 0; i < arms.size(); ++i) {
    const protocols::DeviceArm& arm = arms[i];
    const std::size_t tip = is_tip(arm) ? i : arm.of;
    const auto number = std::count_if(arms.begin(), arms.begin() + static_cast<long>(tip), is_tip);
    const std::string& device =
        options.devices[std::min(static_cast<std::size_t>(number), options.devices.size() - 1)];
    const device::PartUnits unit = arm.units();
    forces.push_back(fmt::format(
        "{:g} {}", unit.newton * std::min(arm.limits.max_force, driver_limit(device, arm, d)),
        unit.force));
    if (!arm.name.empty()) {
      forces.back() += fmt::format(" ({}, {})", arm.name, device::part_word(arm.part));
    }
  }
  return forces;
}

std::vector<std::string> ways_to_stop(const RunOptions& options, const Definition& d,
                                      bool terminal) {
  std::vector<std::string> ways;
  for (const std::string& device : options.devices) {
    if (const auto stop = protocols::stop_button_of(d, device); stop && stop->button >= 0) {
      ways.push_back(
          fmt::format("Press button {} of the {} (counted from 0).", stop->button, device));
    }
  }
  if (options.window) {
    ways.emplace_back("Press Escape on the keyboard of the participant's window, or close it.");
  }
  if (options.console) {
    ways.emplace_back("Press EMERGENCY STOP on the experimenter's page, or Escape there.");
  }
  ways.emplace_back(
      terminal && (options.keyboard || options.console)
          ? "Press Escape in the terminal; Ctrl-C there also ends the session."
          : "Press Ctrl-C in the terminal in which haptrial runs: it also ends the session.");
  ways.emplace_back("Switch the device off at its power switch, or pull its plug.");
  if (d.pedal_use() != protocols::PedalUse::kNone) {
    ways.emplace_back("The pedal does NOT stop the force.");
  }
  return ways;
}

std::string call_line(const protocols::Room& room) {
  if (room.contact.empty() && room.phone.empty()) {
    return "Call: ______________________________";
  }
  const bool both = !room.contact.empty() && !room.phone.empty();
  return fmt::format("Call {}{}{}.", room.contact, both ? ", " : "", room.phone);
}

void add_help(const protocols::Room& room, Document& page) {
  page.table({"If", "Do this"},
             {{"somebody is hurt",
               "Stop the force, switch the device off, free the hand, help the person."},
              {"", call_line(room)},
              {"", "Do not clear the stop or start again before the cause is known."},
              {"", "Write down what happened and when. The session's file holds every tick."},
              {"the program hangs", "Switch the device off first: it may hold its last force."},
              {"", "Press Ctrl-C in the terminal. If nothing happens, close the terminal."},
              {"", "Switch the device on again only when nobody holds the handle."}});
}

void add_files(const StartOptions& options, const Definition& d, Document& page) {
  const std::string backup = backup_folder(options, d);
  page.heading("Files, and how to go on");
  page.table(
      {"Session", "Where"},
      {{"Finished", (fs::absolute(session_folder(options)) / "ID.h5").lexically_normal().string()},
       {"Stopped", "the same with .partial: do not rename, move or open it"},
       {"Backup", backup.empty() ? "none is made: copy the file by hand"
                                 : (fs::path(backup) / d.name / "ID.h5").string()},
       {"To go on", fmt::format("haptrial run {}{} --subject ID --resume",
                                shell_word(options.definition), options.session_words)}});
}

Document card_of(const StartOptions& options, const Experiment& experiment, bool terminal) {
  const Definition& d = *experiment.definition;
  Document page;
  page.title = "Emergency card: " + d.name;
  page.subtitle = fmt::format("Device: {}. Made on {:%Y-%m-%d} by haptrial {}.",
                              fmt::join(options.devices, ", "), fmt::localtime(std::time(nullptr)),
                              program_version());
  page.alarm(fmt::format("Greatest force on the hand: {}.",
                         fmt::join(greatest_forces(options, d), " and ")));
  page.heading("To stop the force at once");
  page.points(ways_to_stop(options, d, terminal));
  page.paragraph("Anybody may stop. The force stays zero until the experimenter clears the stop.");
  add_help(protocols::room_of(d.root()), page);
  add_files(options, d, page);
  return page;
}

/// Writes a page to be printed and laid beside the device: how to stop it, what to do if somebody
/// is hurt or the program hangs, whom to call, where the files lie and how to go on. It needs
/// nothing but the definition, the lab file and the options of the session.
/// @param terminal  sessions have one whose keys they read; those that the studio starts have none
/// @throws InputError if the file is there already; RunError if it cannot be written
void write_emergency_card(const StartOptions& options, const Experiment& experiment, bool terminal,
                          const fs::path& file) {
  WholeFile out(file);
  out.write(analysis::to_html(card_of(options, experiment, terminal)));
  out.finish();
}

using State = MachineCheck::State;

std::string lower_case(const char* word) {
  std::string text = word;
  std::ranges::transform(text, text.begin(), [](unsigned char c) { return std::tolower(c); });
  return text;
}

void print_json(const StartOptions& options, const SessionChecks& found) {
  nlohmann::ordered_json json;
  json["definition"] = options.definition;
  json["participant"] = found.subject;
  json["session"] = found.session;
  json["group"] = found.group;
  json["minutes"] = std::ceil(found.seconds / 60.0);
  json["ready"] = found.ready();
  json["checks"] = nlohmann::json::array();
  for (const MachineCheck& check : found.checks) {
    json["checks"].push_back({{"what", check.what},
                              {"state", lower_case(name_of(check.state))},
                              {"found", check.found}});
  }
  fmt::print("{}\n", json.dump(2, ' ', false, nlohmann::json::error_handler_t::replace));
}

void print_check(const MachineCheck& check) {
  fmt::print("{:<15}  {:<7}  {}\n", check.what, name_of(check.state), check.found);
}

void print_checks(const SessionChecks& found) {
  for (const MachineCheck& check : found.checks) {
    print_check(check);
  }
  const bool limited =
      std::ranges::find(found.checks, State::kLimited, &MachineCheck::state) != found.checks.end();
  fmt::print("\n{}\n", !found.ready() ? "The session cannot begin before what is broken is mended."
                       : limited      ? "The session can begin; see what is limited above."
                                      : "The session can begin.");
  std::fflush(stdout);
}

/// A quiet tone of a second on the sound card. @throws RunError if there is none
void play_tone() {
  constexpr double kPitch = 440.0;  // [Hz]
  constexpr double kLoudness = 0.2;
  double time = 0.0;  // [s]
  const sound::CardPlayer player("default", [&time](std::span<float> part) {
    for (float& sample : part) {
      sample = static_cast<float>(kLoudness * std::sin(2.0 * std::numbers::pi * kPitch * time));
      time += 1.0 / sound::CardPlayer::kRate;
    }
  });
  std::this_thread::sleep_for(std::chrono::seconds(1));
}

MachineCheck asked_sound() {
  try {
    play_tone();
  } catch (const std::exception& error) {
    return {"sound heard", State::kLimited, sentence_of(error)};
  }
  return confirms("A tone was played. Was it heard where the participant sits?")
             ? MachineCheck{"sound heard", State::kReady, "the experimenter heard the tone"}
             : MachineCheck{"sound heard", State::kLimited,
                            "nobody heard the tone; look at plugs, volume and the chosen card"};
}

/// Distance from the eyes to the screen that the definition states; 0: none [m].
double stated_distance(const protocols::Definition& definition) {
  Table root = definition.root();
  if (!root.has("display")) {
    return 0.0;
  }
  Table display = root.table("display");
  return display.has("viewing_distance") ? display.number("viewing_distance", {}, "m") : 0.0;
}

MachineCheck asked_distance(double distance) {
  const std::string where = fmt::format("{:.2f} m from the screen", distance);
  return confirms(fmt::format("Will the participant's eyes be {}?", where))
             ? MachineCheck{"distance", State::kReady, where}
             : MachineCheck{"distance", State::kLimited,
                            "move chair or screen until the eyes are " + where};
}

/// Asks for that which only a person can say.
void ask_person(const Experiment& experiment) {
  const protocols::Definition& d = *experiment.definition;
  if (d.is_heard()) {
    print_check(asked_sound());
  }
  if (const double distance = stated_distance(d); distance > 0.0) {
    print_check(asked_distance(distance));
  }
}

void print_next(const StartOptions& options, const RunEnd& end) {
  if (end.stopped) {
    fmt::print("next: the same command with --resume --subject {} goes on with the trials left\n",
               end.subject);
    return;
  }
  fmt::print(
      "next: haptrial info {} says whether every tick is recorded\n"
      "      haptrial start {} leads through the session of whoever comes next\n",
      shell_word(end.file.string()), shell_word(options.definition));
}

int start(const StartOptions& asked) {
  StartOptions options = asked;
  if (options.json && !options.check) {
    throw InputError("--json is given without --check; add --check or leave it out");
  }
  if (!options.card.empty()) {
    const Experiment experiment =
        load_experiment(options.definition, options.language, given_keys(options.set));
    write_emergency_card(options, experiment, Keyboard::can_read(), options.card);
    fmt::print("{}: print it and lay it beside the device\n", options.card);
    return 0;
  }
  const bool terminal = ::isatty(STDIN_FILENO) != 0 && ::isatty(STDOUT_FILENO) != 0;
  if (!options.check && !terminal) {
    throw InputError(
        "start asks questions and needs a terminal; start --check prints the checklist alone, and "
        "run runs the session");
  }
  check_run_options(options);
  const Experiment experiment =
      load_experiment(options.definition, options.language, given_keys(options.set));
  const SessionChecks found = session_checks(options, experiment);
  if (options.json) {
    print_json(options, found);
  } else {
    print_checks(found);
  }
  if (options.check || !found.ready()) {
    return found.ready() ? 0 : 1;
  }
  ask_person(experiment);
  if (!confirms(fmt::format("Begin the session of {}?", found.subject))) {
    fmt::print("nothing was recorded\n");
    return 1;
  }
  options.checked = true;
  print_next(options, run_command(options));
  return 0;
}

/// The options that were given and hold for the session of whoever comes, so that no option of
/// `run` can be forgotten where the session goes on.
std::string session_words(const CLI::App& sub) {
  const std::set<std::string> others{"--help",     "--subject", "--participant", "--handedness",
                                     "--age-band", "--sex",     "--consent",     "--notes",
                                     "--resume",   "--check",   "--json",        "--card"};
  std::string words;
  for (const CLI::Option* option : sub.get_options()) {
    const std::string name = option->get_name();
    if (option->count() == 0 || !option->nonpositional() || others.contains(name)) {
      continue;
    }
    const bool flag = option->get_items_expected_max() == 0;
    for (const std::string& value : option->results()) {
      words += " " + name + (flag ? "" : " " + shell_word(value));
    }
  }
  return words;
}

}  // namespace

void add_start(CLI::App& app, int& status) {
  CLI::App* sub = subcommand(
      app, "start", "Go through a checklist, then run the session of whoever comes next",
      "haptrial start first_experiment --check",
      {"what run writes; with --card a page (.html)", "guide-experimenter.md#before-each-session"});
  auto options = std::make_shared<StartOptions>();
  run_when_read(*sub, status, [options, sub] {
    options->session_words = session_words(*sub);
    return start(*options);
  });
  StartOptions& o = *options;
  declare_run_options(*sub, o);
  sub->add_flag("--check", o.check,
                "Print the checklist alone; exit status 0 if the session can begin, 1 if not");
  sub->add_flag("--json", o.json, "Print the checklist of --check as JSON");
  sub->add_option(
      "--card", o.card,
      "File for the emergency card of this experiment and device (.html); nothing more is done");
}

}  // namespace haptrial::experiments
