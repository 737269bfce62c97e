#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <filesystem>
#include <optional>
#include <vector>

#include "core/base/counted.h"
#include "core/channel/channel_set.h"
#include "core/record/recovery/recover.h"
#include "experiments/command/subcommand.h"
#include "experiments/studies/registry.h"

namespace haptrial::experiments {
namespace {

struct RecoverOptions {
  std::string file;
  std::string out;
};

/// S01.h5 and S01.h5.partial become S01.recovered.h5, beside them.
std::filesystem::path default_output(std::filesystem::path file) {
  if (file.extension() == ".partial") {
    file.replace_extension();
  }
  return file.replace_extension(".recovered.h5");
}

/// The tables of a session with channels, which only its definition knows.
class ChannelTables {
 public:
  /// @returns none for a session without channels
  record::TableList of(const record::SessionInfo& info) {
    Table root = Table::parse(info.definition, info.definition_name);
    const std::vector<channel::ChannelOptions> options = channel::read_channels(root);
    if (options.empty()) {
      return {};
    }
    const record::TableList tables =
        record::with_tables(study_of(root).protocol().tables(), record::common_tables());
    channels_.emplace(options, tables, false);
    return record::with_tables(tables, channels_->tables());
  }

 private:
  std::optional<channel::ChannelSet> channels_;
};

/// @returns 0 when something was recovered, else 1.
int recover(const RecoverOptions& options) {
  const std::string& file = options.file;
  const std::filesystem::path to =
      options.out.empty() ? default_output(file) : std::filesystem::path(options.out);
  ChannelTables channels;
  const record::Recovery found = record::recover_session(
      file, to, known_tables(), [&](const record::SessionInfo& info) { return channels.of(info); });
  if (!found.anything()) {
    fmt::print("{}: nothing of a session is left in its {} bytes; nothing was written\n", file,
               found.file_bytes);
    return 1;
  }
  fmt::print("subject     {}\n",
             found.info ? found.subject
                        : "unknown: the definition and the description of the session are lost");
  fmt::print("rows        {}, sequence {} to {}, {} missing between them\n", found.samples,
             found.first_sequence, found.last_sequence, found.missing);
  fmt::print("passes      {}, {} incomplete\n", found.passes, found.passes_cut);
  fmt::print("also        {}, stimuli of {}, {}\n", counted(found.events, "event", "events"),
             counted(found.stimulus_blocks, "block", "blocks"),
             counted(found.frames, "frame", "frames"));
  fmt::print("loop        {}\n", found.ended ? "complete" : "its counts are lost");
  fmt::print("written to  {}; {} is unchanged\n", to.string(), file);
  return 0;
}

}  // namespace

void add_recover(CLI::App& app, int& status) {
  CLI::App* sub = subcommand(app, "recover", "Save what a damaged session file still holds",
                             "haptrial recover out/sessions/P01.h5.partial",
                             {"a session file of what could be read", "session-file.md"});
  auto& o = options_of<RecoverOptions>(*sub, status, recover);
  sub->add_option("FILE", o.file, "Damaged session file (.h5, .partial), which is left unchanged")
      ->required();
  sub->add_option("OUT", o.out, "New session file (default: S01.recovered.h5 for S01.h5)");
}

}  // namespace haptrial::experiments
