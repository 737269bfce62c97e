#include <fmt/format.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <filesystem>
#include <iostream>
#include <string>
#include <vector>

#include "core/base/counted.h"
#include "core/base/error.h"
#include "experiments/command/subcommand.h"
#include "experiments/studies/registry.h"
#include "experiments/study/withdrawal.h"

namespace haptrial::experiments {
namespace {

namespace fs = std::filesystem;

struct WithdrawOptions {
  std::string folder;
  std::string subject;
  std::vector<std::string> also;
  bool dry{false};
  bool sure{false};
};

void print_files(const char* what, const std::vector<fs::path>& files) {
  for (const fs::path& file : files) {
    fmt::print("{} {}\n", what, file.string());
  }
}

/// @throws InputError unless the person at the terminal types the identifier
void confirm(const std::string& subject) {
  if (::isatty(STDIN_FILENO) == 0) {
    throw InputError("nothing was deleted: give --yes where nobody can be asked");
  }
  fmt::print("Deleted files cannot be had back. Type {} to delete them: ", subject);
  std::fflush(stdout);
  std::string typed;
  std::getline(std::cin, typed);
  if (typed != subject) {
    throw InputError("nothing was deleted");
  }
}

int withdraw_participant(const WithdrawOptions& o) {
  std::vector<fs::path> folders{o.folder};
  folders.insert(folders.end(), o.also.begin(), o.also.end());
  const Withdrawal found = find_withdrawal(folders, o.subject, protocol_of);
  const char* verb = o.dry ? "would delete" : "deletes";
  print_files(verb, found.sessions);
  print_files(verb, found.made);
  print_files("leaves, although it names the participant:", found.others);
  if (o.dry) {
    return 0;
  }
  if (!o.sure) {
    confirm(o.subject);
  }
  withdraw(found, folders, o.subject);
  fmt::print(
      "deleted: {} of {}, and {} made from sessions of the study. Run analyze and export again; "
      "films, tables and reports elsewhere, and those that were sent, are for you to find.\n",
      counted(static_cast<int>(found.sessions.size()), "session file", "session files"), o.subject,
      counted(static_cast<int>(found.made.size()), "file", "files"));
  return 0;
}

}  // namespace

void add_withdraw(CLI::App& app, int& status) {
  CLI::App* sub = subcommand(app, "withdraw", "Delete a participant from a study's folders",
                             "haptrial withdraw out/curl_field P03 --dry-run",
                             {"withdrawals.csv in FOLDER", "guide-data.md"});
  auto& o = options_of<WithdrawOptions>(*sub, status, withdraw_participant);
  sub->add_option("FOLDER", o.folder, "Folder of the study's sessions")->required();
  sub->add_option("SUBJECT", o.subject, "Identifier of the participant, such as P03")->required();
  sub->add_option("--also", o.also,
                  "Another folder to look through, such as a backup or an export; may be repeated")
      ->allow_extra_args(false);
  auto* dry = sub->add_flag("--dry-run", o.dry, "List what would be deleted, and stop");
  sub->add_flag("--yes", o.sure, "Do not ask")->excludes(dry);
}

}  // namespace haptrial::experiments
