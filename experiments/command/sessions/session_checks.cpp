#include "experiments/command/sessions/session_checks.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <sys/stat.h>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <iterator>
#include <map>
#include <system_error>
#include <thread>

#include "core/base/counted.h"
#include "core/base/error.h"
#include "core/base/exception_words.h"
#include "core/channel/channel_set.h"
#include "core/device/catalog.h"
#include "core/record/rows/common_tables.h"
#include "experiments/command/sessions/next_session.h"
#include "experiments/command/sessions/run_checks.h"
#include "experiments/command/start/doctor_checks.h"
#include "experiments/runner/devices.h"
#include "experiments/study/session_times.h"
#include "protocols/definition/button_uses.h"
#include "protocols/definition/groups.h"
#include "protocols/definition/mirroring.h"

namespace haptrial::experiments {
namespace {

using State = MachineCheck::State;
using Clock = std::chrono::steady_clock;

bool all_live(const channel::ChannelSet& channels) {
  return std::ranges::all_of(channels.seen(), [](const auto& seen) { return seen.state.live; });
}

/// Gives the instruments a moment to send something.
void wait_for_data(channel::ChannelSet& channels, Clock::time_point begin) {
  constexpr std::chrono::milliseconds kLook{20}, kLongest{2000};
  const auto now_ns = [&] { return std::chrono::nanoseconds(Clock::now() - begin).count(); };
  const auto end = Clock::now() + kLongest;
  channels.begin();
  while (!all_live(channels) && Clock::now() < end) {
    std::this_thread::sleep_for(kLook);
    channels.collect(now_ns(), [](const record::Rows&) {});
  }
}

MachineCheck check_of(const channel::ChannelSet::Seen& seen,
                      const std::vector<std::string>& missing) {
  const channel::ChannelOptions& options = *seen.options;
  if (seen.state.live) {
    const auto quantities = std::min(options.plan.quantities.size(), seen.state.values.size());
    const std::vector<double> values(seen.state.values.begin(),
                                     seen.state.values.begin() + static_cast<long>(quantities));
    return {"channel " + options.name, State::kReady,
            fmt::format("answers; newest values {:.4g}", fmt::join(values, ", "))};
  }
  const auto why = std::ranges::find_if(missing, [&](const std::string& sentence) {
    return sentence.find(options.name) != std::string::npos;
  });
  return {"channel " + options.name, options.required ? State::kBroken : State::kLimited,
          why != missing.end() ? *why : "is open but sends nothing; check instrument and cable"};
}

/// Opens the channels of a definition for a moment: whether each gives data, and its newest values.
/// A channel that a session needs is broken if it does not answer, any other is limited.
std::vector<MachineCheck> channel_checks(const Experiment& experiment) {
  const protocols::Definition& d = *experiment.definition;
  if (d.channels.empty()) {
    return {};
  }
  try {
    const record::TableList tables =
        record::with_tables(experiment.study->protocol().tables(), record::common_tables());
    channel::ChannelSet channels(d.channels, tables, true);
    const Clock::time_point begin = Clock::now();
    const std::vector<std::string> missing = channels.start(
        [begin] { return std::chrono::nanoseconds(Clock::now() - begin).count(); }, {});
    wait_for_data(channels, begin);
    std::vector<MachineCheck> checks;
    for (const auto& seen : channels.seen()) {
      checks.push_back(check_of(seen, missing));
    }
    return checks;
  } catch (const std::exception& error) {
    return {{"channels", State::kBroken, sentence_of(error)}};
  }
}

namespace fs = std::filesystem;
using protocols::Definition;

constexpr double kMegabyte = 1e6;

/// Chooses who comes, and refuses what `run` would refuse later.
MachineCheck check_participant(RunOptions& options, const Experiment& experiment) {
  const Definition& d = *experiment.definition;
  try {
    if (!options.pilot || options.subject.empty()) {
      choose_session(options, experiment);
    }
    const fs::path file = session_file(options, d);
    options.seed = session_seed(options, file);
    check_recording(options, experiment.study->protocol(), d);
    check_pages(options, d);
    const std::string& device = options.devices.front();
    if (!options.resume && device != "virtual" && !replayed_file(device)) {
      protocols::mirror_for(options.person.handedness, *experiment.definition);
    }
    check_session_file(options, file);
    const std::string changed =
        options.resume ? "" : check_study(options, experiment.study->protocol(), d, file);
    std::string words = options.subject;
    words += d.sessions() > 1
                 ? fmt::format(", session {} of {}", options.session.value_or(1), d.sessions())
                 : "";
    words += options.pilot ? ", a pilot" : options.resume ? ", to be resumed" : "";
    return {"participant", State::kReady,
            words + ", into " + file.string() + (changed.empty() ? "" : "; " + changed)};
  } catch (const InputError& error) {
    return {"participant", State::kBroken, error.what()};
  }
}

/// The group that the number at the end of the identifier says; empty: the study has none.
MachineCheck check_group(const RunOptions& options, const Definition& d, std::string& group) {
  if (d.groups.size() < 2 || options.subject.empty()) {
    return {"group", State::kUnused, "the study has one group of everybody"};
  }
  try {
    group = protocols::group_of(d.groups, options.subject);
    return {"group", State::kReady, group};
  } catch (const InputError& error) {
    return {"group", options.pilot ? State::kLimited : State::kBroken, error.what()};
  }
}

std::vector<MachineCheck> check_definition(const RunOptions& options,
                                           const Experiment& experiment) {
  std::vector<std::string> warnings = warnings_of(experiment);
  for (std::string& more : protocols::button_warnings(*experiment.definition, options.devices)) {
    if (std::ranges::find(warnings, more) == warnings.end()) {
      warnings.push_back(std::move(more));
    }
  }
  std::ranges::move(undrawable_texts(experiment), std::back_inserter(warnings));
  std::vector<MachineCheck> checks;
  for (const std::string& warning : warnings) {
    checks.push_back({"definition", State::kLimited, warning});
  }
  if (checks.empty()) {
    checks.push_back({"definition", State::kReady, "valid, without warnings"});
  }
  return checks;
}

MachineCheck check_consent(const RunOptions& options, const Definition& d) {
  const bool page = std::ranges::any_of(d.pages.pages, [](const questions::Page& each) {
    return each.kind == questions::PageKind::kConsent;
  });
  if (page) {
    return {"consent", State::kReady, "the participant is asked on a page"};
  }
  if (!options.person.consent_confirmed.empty()) {
    return {"consent", State::kReady, "confirmed by --consent"};
  }
  return {"consent", State::kLimited,
          "the definition has no page of kind consent; let the participant sign a form and add "
          "--consent DATE"};
}

/// Every device, as the options' library finds it.
using Listings = std::vector<device::DeviceListing>;

Listings listed_devices(const RunOptions& options) {
  return device::list_devices(
      options.library.empty()
          ? std::map<std::string, std::string>{}
          : std::map<std::string, std::string>{{options.devices.front(), options.library}});
}

/// The device itself is opened by the session: opening may move the handle.
std::vector<MachineCheck> check_chosen_devices(const RunOptions& options, const Listings& all) {
  std::vector<MachineCheck> checks;
  for (const std::string& name : options.devices) {
    const auto at = std::ranges::find(all, name, &device::DeviceListing::name);
    if (at == all.end()) {
      checks.push_back({"device", State::kReady, name + ", which the session opens"});
    } else {
      checks.push_back({"device", at->available ? State::kReady : State::kBroken,
                        fmt::format("{}: {}", name, at->what)});
    }
  }
  return checks;
}

MachineCheck check_certificate(const RunOptions& options, const Definition& d) {
  const std::string& name = options.devices.front();
  if (name == "virtual" || name == "mouse" || name == "gamepad" || replayed_file(name)) {
    return {"certificate", State::kUnused, "none is needed for " + name};
  }
  if (!d.certificate) {
    return {"certificate", State::kLimited,
            fmt::format("[device] names none; haptrial device-test {} --certificate FOLDER makes "
                        "one, so that reports give forces as measured",
                        name)};
  }
  return {"certificate", d.certificate->simulated ? State::kLimited : State::kReady,
          fmt::format("{}, of {}{}", d.certificate->file, d.certificate->device,
                      d.certificate->simulated ? "; a simulated one: make one of the device itself"
                                               : "; compare the name with the device's plate")};
}

/// The nearest folder that is there: that of the files may not have been made yet.
fs::path there_above(fs::path folder) {
  std::error_code ignored;
  folder = fs::absolute(folder, ignored).lexically_normal();
  while (!fs::is_directory(folder, ignored) && folder.has_relative_path()) {
    folder = folder.parent_path();
  }
  return folder;
}

double free_bytes(const fs::path& folder) {
  std::error_code error;
  const auto space = fs::space(folder, error);
  return error ? 0.0 : static_cast<double>(space.available);
}

/// @param planned  at most [s]
MachineCheck check_duration(const fs::path& folder, const Definition& d, double planned) {
  std::string found =
      fmt::format("takes at most about {}, pages and pauses not counted", planned_minutes(planned));
  if (const auto times = recorded_times(folder, d)) {
    found += "; before, it took " + time_words(*times);
  }
  return {"duration", State::kReady, found};
}

/// Bytes that a session writes at most, roughly: the rows of its samples as they are in memory, and
/// half as much for other tables.
double expected_bytes(const Definition& d, double seconds) {
  return 1.5 * static_cast<double>(sizeof(record::Sample)) * d.rate * seconds;
}

MachineCheck check_space(const char* what, const fs::path& folder, double needed) {
  const double free = free_bytes(folder);
  return {what,
          free < needed         ? State::kBroken
          : free < 2.0 * needed ? State::kLimited
                                : State::kReady,
          fmt::format("{}: {:.0f} MB are free, and the session needs about {:.0f} MB{}",
                      folder.string(), free / kMegabyte, needed / kMegabyte,
                      free < 2.0 * needed ? "; make room" : "")};
}

bool on_one_disk(const fs::path& a, const fs::path& b) {
  struct stat first {};
  struct stat second {};
  return ::stat(a.c_str(), &first) == 0 && ::stat(b.c_str(), &second) == 0 &&
         first.st_dev == second.st_dev;
}

/// A backup that fails spoils no session: never broken.
MachineCheck check_backup(const std::string& folder, const fs::path& files, double needed) {
  std::error_code ignored;
  if (folder.empty()) {
    return {"backup", State::kLimited,
            "none is made; write backup in [room] of the lab file, or copy the file by hand"};
  }
  if (!fs::is_directory(folder, ignored)) {
    return {"backup", State::kLimited,
            folder + ": is not there; plug in its disk, or name another folder with --backup"};
  }
  if (const MachineCheck written = check_disk(folder); written.state == State::kBroken) {
    return {"backup", State::kLimited, written.found};
  }
  if (on_one_disk(folder, files)) {
    return {"backup", State::kLimited,
            folder + ": is on the same disk as the session, so that both may be lost at once"};
  }
  MachineCheck space = check_space("backup", folder, needed);
  space.state = space.state == State::kReady ? State::kReady : State::kLimited;
  return space;
}

/// The machine's checks that matter for this session: not other devices, nor what it does without.
std::vector<MachineCheck> check_machine(const RunOptions& options, const Definition& d,
                                        const fs::path& files, const Listings& devices) {
  std::vector<MachineCheck> checks = doctor_checks(&d, files);
  const std::string& first = options.devices.front();
  std::erase_if(checks, [&](const MachineCheck& check) {
    const bool listed =
        std::ranges::find(devices, check.what, &device::DeviceListing::name) != devices.end();
    const bool touch = check.what.starts_with("touch") && first != "open-haptics";
    const bool window = check.what == "window" && !options.window;
    const bool stream = check.what == "stream" && options.stream;
    const bool pedal = check.what == "pedal" && (first == "virtual" || replayed_file(first));
    return listed || touch || window || pedal ||
           (!stream && (check.what == "video" || check.what == "stream")) ||
           (check.what == "sound" && !d.is_heard());
  });
  return checks;
}

}  // namespace

bool SessionChecks::ready() const {
  return std::ranges::find(checks, State::kBroken, &MachineCheck::state) == checks.end();
}

std::optional<MachineCheck> check_end_of_study(const RunOptions& options,
                                               const Experiment& experiment) {
  const bool has_begun = options.resume || options.session.value_or(1) > 1;
  if (options.pilot || has_begun) {
    return std::nullopt;
  }
  try {
    const auto standing = study_standing(experiment, session_folder(options), 1);
    if (!standing) {
      return std::nullopt;
    }
    return MachineCheck{"study", has_ended(standing) ? State::kLimited : State::kReady,
                        words_of(*standing)};
  } catch (const InputError& error) {
    return MachineCheck{"study", State::kLimited, error.what()};
  }
}

SessionChecks session_checks(RunOptions& options, const Experiment& experiment) {
  const Definition& d = *experiment.definition;
  options.out = session_folder(options);
  SessionChecks found;
  const auto add = [&found](std::vector<MachineCheck> more) {
    std::ranges::move(more, std::back_inserter(found.checks));
  };
  found.checks.push_back(check_participant(options, experiment));
  found.checks.push_back(check_group(options, d, found.group));
  found.subject = options.subject;
  found.session = options.session.value_or(1);
  found.seconds = session_seconds(d, options.trials.value_or(d.design.trials));
  if (auto end = check_end_of_study(options, experiment)) {
    found.checks.push_back(std::move(*end));
  }
  found.checks.push_back(check_duration(options.out, d, found.seconds));
  add(check_definition(options, experiment));
  found.checks.push_back(check_consent(options, d));
  const fs::path files = there_above(session_folder(options));
  const Listings devices = listed_devices(options);
  add(check_machine(options, d, files, devices));
  const double needed = expected_bytes(d, found.seconds);
  found.checks.push_back(check_space("room for files", files, needed));
  found.checks.push_back(check_backup(backup_folder(options, d), files, needed));
  add(check_chosen_devices(options, devices));
  found.checks.push_back(check_certificate(options, d));
  add(channel_checks(experiment));
  return found;
}

}  // namespace haptrial::experiments
