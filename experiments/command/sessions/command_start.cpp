#include <fmt/format.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cctype>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <numbers>
#include <string>
#include <thread>

#include "core/base/error.h"
#include "core/base/exception_words.h"
#include "core/sound/card_player.h"
#include "experiments/command/sessions/confirmation.h"
#include "experiments/command/sessions/emergency_card.h"
#include "experiments/command/sessions/run_checks.h"
#include "experiments/command/sessions/run_command.h"
#include "experiments/command/sessions/session_checks.h"
#include "experiments/command/subcommand.h"
#include "experiments/control/keyboard.h"

namespace haptrial::experiments {
namespace {

using State = MachineCheck::State;

struct StartOptions : RunOptions {
  bool check{false};
  bool json{false};
  std::string card;
};

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
      end.file.string(), options.definition);
}

int start(const StartOptions& asked) {
  StartOptions options = asked;
  if (options.json && !options.check) {
    throw InputError("--json is given without --check; add --check or leave it out");
  }
  if (!options.card.empty()) {
    const Experiment experiment = load_experiment(options.definition, options.language);
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
  const Experiment experiment = load_experiment(options.definition, options.language);
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

}  // namespace

void add_start(CLI::App& app, int& status) {
  CLI::App* sub = subcommand(
      app, "start", "Go through a checklist, then run the session of whoever comes next",
      "haptrial start first_experiment --check",
      {"what run writes; with --card a page (.html)", "guide-experimenter.md#before-each-session"});
  auto& o = options_of<StartOptions>(*sub, status, start);
  declare_run_options(*sub, o);
  sub->add_flag("--check", o.check,
                "Print the checklist alone; exit status 0 if the session can begin, 1 if not");
  sub->add_flag("--json", o.json, "Print the checklist of --check as JSON");
  sub->add_option(
      "--card", o.card,
      "File for the emergency card of this experiment and device (.html); nothing more is done");
}

}  // namespace haptrial::experiments
