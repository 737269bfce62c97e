#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <charconv>
#include <filesystem>

#include "analysis/power/power_report.h"
#include "core/base/error.h"
#include "experiments/command/arguments.h"
#include "experiments/command/subcommand.h"
#include "experiments/control/signals.h"
#include "experiments/power/power_run.h"
#include "experiments/study/shared_work.h"

namespace haptrial::experiments {
namespace fs = std::filesystem;
namespace {

struct PowerSimulateOptions {
  std::string question;
  std::string out;
  std::string part;
  std::optional<int> jobs;
  std::optional<double> minutes;
};

constexpr int kMostTasks = 1'000'000;

/// "2/8" as 2 and 8.
void read_part_of(const std::string& text, PowerShare& share) {
  const char* end = text.data() + text.size();
  const auto first = std::from_chars(text.data(), end, share.part);
  const bool slash = first.ec == std::errc() && first.ptr != end && *first.ptr == '/';
  const auto second = slash ? std::from_chars(first.ptr + 1, end, share.of) : first;
  if (!slash || second.ec != std::errc() || second.ptr != end || share.of < 1 ||
      share.of > kMostTasks || share.part < 1 || share.part > share.of) {
    throw InputError(
        fmt::format("--part is '{}'; allowed: I/N with I from 1 to N, such as 2/8", text));
  }
}

void write_report(const PowerFolder& folder) {
  const analysis::PowerResult result = folder.merged();
  analysis::write_power(result, folder.path());
  for (const std::string& line : analysis::power_lines(result)) {
    fmt::print("{}\n", line);
  }
  fmt::print("report: {}\n",
             (fs::absolute(folder.path()) / "report.html").lexically_normal().string());
}

int power_simulate(const PowerSimulateOptions& options) {
  watch_for_interrupt();
  PowerShare share;
  const std::optional<LaunchRank> rank = launch_rank();
  share.jobs = rank && !options.jobs ? 1 : checked_jobs(options.jobs);
  if (!options.part.empty()) {
    read_part_of(options.part, share);
  }
  if (options.minutes) {
    share.minutes = checked_real("--minutes", *options.minutes, 0.0, 1e6);
  }
  const PowerQuestion question = load_question(options.question);
  check_watched(question);
  const PowerFolder folder(
      options.out.empty() ? fs::path("out") / (question.title + "-power") : fs::path(options.out),
      question);
  if (rank) {
    share.start = static_cast<double>(rank->rank) / rank->size;
  }
  const PowerProgress done = fill(folder, question, share);
  if (rank && rank->rank > 0 && !(done.stopped && interrupted())) {
    return 0;  // the first of them reports
  }
  fmt::print("{} of {} parts were made in {:.1f} s: {} simulated trials, {:.0f} a second\n",
             done.made, folder.units().size(), done.seconds, done.trials,
             static_cast<double>(done.trials) / std::max(1e-9, done.seconds));
  if (done.stopped && options.part.empty() && !options.minutes) {
    throw RunError(fmt::format("interrupted; {} parts are missing, and the same command goes on",
                               done.missing));
  }
  if (done.missing > 0 || !options.part.empty()) {
    fmt::print("{} parts are missing; next: haptrial power {} {}\n", done.missing,
               done.missing > 0 ? "status" : "merge", folder.path().string());
    return 0;
  }
  write_report(folder);
  return 0;
}

int power_merge(const std::string& folder) {
  const PowerQuestion question = PowerFolder::question_of(folder);
  write_report(PowerFolder(folder, question));
  return 0;
}

}  // namespace

void add_power_simulate(CLI::App& power, int& status) {
  CLI::App* sub = subcommand(
      power, "simulate", "Simulate a study many times and count what its report finds",
      "haptrial power simulate docs/worked/power/repetition.toml --out out/repetition",
      {"parts and, once they are all there, a report, tables and a figure in the folder of --out",
       "guide-power.md"});
  auto& o = options_of<PowerSimulateOptions>(*sub, status, power_simulate);
  sub->add_option("DEFINITION", o.question,
                  "Definition with a table [power], or a file with [power] that names one (.toml)")
      ->required();
  sub->add_option("--out", o.out, "Folder of the simulation (default: out/NAME-power)");
  sub->add_option("--jobs", o.jobs, kJobsHelp);
  sub->add_option("--part", o.part, "Do part I of N of the work, I/N, without a report");
  sub->add_option("--minutes", o.minutes, "Begin nothing after this time, and exit with status 0");
}

void add_power_merge(CLI::App& power, int& status) {
  CLI::App* sub =
      subcommand(power, "merge", "Make the report of a simulation whose parts are all there",
                 "haptrial power merge out/repetition", {"", "guide-power.md"});
  auto& folder = options_of<std::string>(*sub, status, power_merge);
  sub->add_option("DIR", folder, "Folder of a simulation")->required();
}

}  // namespace haptrial::experiments
