#pragma once

#include <optional>
#include <string>

namespace haptrial::experiments {

/// The subcommands of haptrial: each prints to standard output and returns an exit status. Bad
/// input and failures come as InputError and RunError.

struct DryRunOptions {
  std::string definition;
  std::optional<int> subjects;  // default: as the definition says
  std::string seed{"1"};
  std::optional<int> jobs;  // default: one per processor
  std::string out;          // default: a new folder out/NAME-001
  int frames{0};
  int trials{0};
};
int dry_run(const DryRunOptions& options);

struct RunOptions {
  std::string definition;
  std::string subject;
  std::string device{"virtual"};
  std::string seed{"1"};
  std::optional<int> participant;  // default: the number at the end of the subject's identifier
  std::string out{"out/sessions"};
  int trials{0};
};
int run(const RunOptions& options);

int analyze(const std::string& folder, std::optional<int> jobs);
int info(const std::string& file);
int validate(const std::string& definition);
int devices();

}  // namespace haptrial::experiments
