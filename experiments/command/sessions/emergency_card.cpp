#include "experiments/command/sessions/emergency_card.h"

#include <fmt/chrono.h>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <ctime>
#include <string>
#include <vector>

#include "analysis/document/document.h"
#include "core/base/definition/table.h"
#include "core/base/whole_file.h"
#include "experiments/runner/version.h"
#include "protocols/definition/button_uses.h"
#include "protocols/definition/room.h"

namespace haptrial::experiments {
namespace {

namespace fs = std::filesystem;
using analysis::Document;
using protocols::Definition;

/// The greatest force that a session may command with this device [N].
double greatest_force(const std::string& device, const Definition& d) {
  double force = d.envelope.max_force;
  for (const device::VendorDevice& vendor : device::vendor_devices()) {
    if (vendor.name == device) {
      force = std::min(force, vendor.limits(d.vendor).max_force);
    }
  }
  return force;
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

/// The options of the session that matter when it goes on.
std::string options_of_session(const RunOptions& options) {
  std::string words;
  for (const std::string& device : options.devices) {
    words += " --device " + device;
  }
  words += options.window ? " --window" : "";
  words += options.console ? " --console" : "";
  words += options.keyboard ? " --keyboard" : "";
  words += options.out.empty() ? "" : " --out " + options.out;
  return words;
}

void add_files(const RunOptions& options, const Definition& d, Document& page) {
  const std::string backup = backup_folder(options, d);
  page.heading("Files, and how to go on");
  page.table(
      {"Session", "Where"},
      {{"Finished", (fs::absolute(session_folder(options)) / "ID.h5").lexically_normal().string()},
       {"Stopped", "the same with .partial: do not rename, move or open it"},
       {"Backup", backup.empty() ? "none is made: copy the file by hand"
                                 : (fs::path(backup) / d.name / "ID.h5").string()},
       {"To go on", fmt::format("haptrial run {}{} --subject ID --resume", options.definition,
                                options_of_session(options))}});
}

Document card_of(const RunOptions& options, const Experiment& experiment, bool terminal) {
  const Definition& d = *experiment.definition;
  Document page;
  page.title = "Emergency card: " + d.name;
  page.subtitle = fmt::format("Device: {}. Made on {:%Y-%m-%d} by haptrial {}.",
                              fmt::join(options.devices, ", "), fmt::localtime(std::time(nullptr)),
                              program_version());
  std::vector<std::string> forces;
  for (const std::string& device : options.devices) {
    forces.push_back(fmt::format("{:g} N", greatest_force(device, d)));
  }
  page.alarm(fmt::format("Greatest force on the hand: {}.", fmt::join(forces, " and ")));
  page.heading("To stop the force at once");
  page.points(ways_to_stop(options, d, terminal));
  page.paragraph("Anybody may stop. The force stays zero until the experimenter clears the stop.");
  add_help(protocols::room_of(d.root()), page);
  add_files(options, d, page);
  return page;
}

}  // namespace

void write_emergency_card(const RunOptions& options, const Experiment& experiment, bool terminal,
                          const fs::path& file) {
  WholeFile out(file);
  out.write(analysis::to_html(card_of(options, experiment, terminal)));
  out.finish();
}

}  // namespace haptrial::experiments
