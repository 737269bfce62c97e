#include <fmt/chrono.h>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <chrono>
#include <ctime>
#include <optional>
#include <thread>
#include <vector>

#include "core/base/definition/table.h"
#include "core/base/error.h"
#include "core/channel/channel_set.h"
#include "core/record/hdf5/session_writer.h"
#include "experiments/command/sessions/live_reading.h"
#include "experiments/command/subcommand.h"
#include "experiments/control/signals.h"
#include "experiments/runner/version.h"
#include "experiments/studies/experiment.h"
#include "experiments/study/backup.h"
#include "protocols/definition/room.h"

namespace haptrial::experiments {
namespace {

struct RecordOptions {
  std::string definition;
  std::string file;
  std::string subject{"S01"};
  std::optional<double> seconds;
  std::string backup;
};

record::SessionInfo info_of(const protocols::Definition& d, const RecordOptions& options) {
  record::SessionInfo info;
  info.program_version = program_version();
  info.program_commit = program_commit();
  info.definition = d.text;
  info.definition_name = d.file_name;
  info.subject = options.subject;
  info.device = "none";
  info.clock = "real";
  info.simulated = false;
  info.rate = d.rate;
  info.start_utc = fmt::format("{:%Y-%m-%dT%H:%M:%SZ}", fmt::gmtime(std::time(nullptr)));
  return info;
}

/// Time since the recording began.
class Stopwatch {
 public:
  std::int64_t ns() const {
    return std::chrono::nanoseconds(std::chrono::steady_clock::now() - begin_).count();
  }
  double seconds() const { return 1e-9 * static_cast<double>(ns()); }

 private:
  std::chrono::steady_clock::time_point begin_{std::chrono::steady_clock::now()};
};

void note(record::SessionWriter& writer, std::int64_t now_ns, const std::string& sentence) {
  fmt::print("{}\n", sentence);
  writer.add_event({now_ns, "notice", sentence});
}

int record(const RecordOptions& options) {
  constexpr std::chrono::milliseconds kLook{50};
  constexpr double kForEver = 1e9;  // [s]
  watch_for_interrupt();
  const Experiment experiment = load_experiment(options.definition);
  const protocols::Definition& d = *experiment.definition;
  if (d.channels.empty()) {
    throw InputError(fmt::format("{}: has no channels; state an instrument in [channels.NAME]",
                                 options.definition));
  }
  if (options.file.empty()) {
    return print_live_channels(d, options.seconds.value_or(kForEver));
  }
  const record::TableList tables =
      record::with_tables(experiment.study->protocol().tables(), record::common_tables());
  channel::ChannelSet channels(d.channels, tables, true);
  const Stopwatch watch;
  const std::vector<std::string> missing = channels.start([&] { return watch.ns(); }, {});
  record::SessionWriter writer(options.file, info_of(d, options), channels.tables());
  writer.add_event({0, "session_start", "channels alone"});
  for (const std::string& notice : missing) {
    note(writer, watch.ns(), notice);
  }
  channels.begin();
  fmt::print("recording {} into {}; Ctrl-C ends it\n",
             fmt::join(channel::names_of_values(d.channels), ", "), options.file);
  const auto keep = [&] {
    channels.collect(watch.ns(), [&](const record::Rows& rows) { writer.add(rows); });
    for (const std::string& news : channels.take_news()) {
      note(writer, watch.ns(), news);
    }
    writer.flush();
  };
  while (!interrupted() && watch.seconds() < options.seconds.value_or(kForEver)) {
    std::this_thread::sleep_for(kLook);
    keep();
  }
  keep();
  writer.add_event({watch.ns(), "session_end", interrupted() ? "by the experimenter" : "in time"});
  writer.set_timing({}, {0, 0, 0});
  writer.close();
  fmt::print("{}: {:.1f} s\n", options.file, watch.seconds());
  const std::string folder =
      options.backup.empty() ? protocols::room_of(d.root()).backup : options.backup;
  if (!folder.empty()) {
    const BackupResult backup = try_back_up(options.file, folder, d.name);
    fmt::print(backup.kept ? stdout : stderr, "{}\n", backup.sentence);
  }
  return 0;
}

}  // namespace

void add_record(CLI::App& app, int& status) {
  CLI::App* sub =
      subcommand(app, "record", "Record the channels of a definition alone, or show their values",
                 "haptrial record study.toml grip.h5 --seconds 10",
                 {"a session file without trials", "channels.md"});
  auto& o = options_of<RecordOptions>(*sub, status, record);
  sub->add_option("DEFINITION", o.definition, "Definition with [channels] (.toml)")->required();
  sub->add_option(
      "FILE", o.file,
      "New session file (.h5); without it the newest values are printed, and nothing is "
      "recorded");
  sub->add_option("--subject", o.subject, "Whom the recording is of")->capture_default_str();
  sub->add_option("--seconds", o.seconds, "End by itself after this time [s]")
      ->check(CLI::Range(0.1, 1e6));
  sub->add_option("--backup", o.backup,
                  "Folder on another disk for a copy of the file (default: backup of [room])");
}

}  // namespace haptrial::experiments
