#include "experiments/commands.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <filesystem>

#include "core/base/error.h"
#include "experiments/arguments.h"
#include "experiments/interrupt.h"
#include "experiments/session.h"

namespace haptrial::experiments {
namespace fs = std::filesystem;
namespace {

/// An identifier becomes a file name: no path may hide in it.
void check_subject(const std::string& subject) {
  constexpr std::size_t kLongest = 64;
  const bool plain = std::all_of(subject.begin(), subject.end(), [](unsigned char c) {
    return std::isalnum(c) != 0 || c == '-' || c == '_';
  });
  if (subject.empty() || subject.size() > kLongest || !plain) {
    throw InputError(fmt::format("--subject is '{}'; allowed: 1 to {} letters, digits, '-' and '_'",
                                 subject, kLongest));
  }
}

int participant_of(const RunOptions& options) {
  constexpr int kMost = 10000;
  if (options.participant) {
    return checked_number("--participant", *options.participant, 1, kMost) - 1;
  }
  const auto letter = options.subject.find_last_not_of("0123456789");
  const std::string digits = options.subject.substr(letter == std::string::npos ? 0 : letter + 1);
  if (digits.empty() || digits.size() > 5 || std::stoi(digits) < 1 || std::stoi(digits) > kMost) {
    throw InputError(
        fmt::format("--subject '{}' does not end in a number from 1 to {}, so the order "
                    "of conditions is not known; add --participant NUMBER",
                    options.subject, kMost));
  }
  return std::stoi(digits) - 1;
}

}  // namespace

int run(const RunOptions& options) {
  watch_for_interrupt();
  const Definition definition = load_definition(options.definition);
  check_subject(options.subject);
  if (options.device != "virtual") {
    throw InputError(fmt::format("--device is '{}'; allowed: virtual (haptrial devices lists them)",
                                 options.device));
  }
  SessionRequest request;
  request.definition = &definition;
  request.subject = options.subject;
  request.participant = participant_of(options);
  request.seed = checked_seed(options.seed);
  request.clock = realtime::ClockKind::kReal;
  request.max_trials = checked_number("--trials", options.trials, 0, definition.design.trials);
  std::error_code error;
  fs::create_directories(options.out, error);
  if (error) {
    throw InputError(
        fmt::format("{}: the folder cannot be made ({})", options.out, error.message()));
  }
  request.file = fs::path(options.out) / (options.subject + ".h5");
  const SessionSummary done = run_session(request);
  if (!done.notice.empty()) {
    fmt::print("{}\n", done.notice);
  }
  fmt::print("session: {}\n{} ticks at {} Hz, {} overruns, {} records lost, {} passes aborted\n",
             request.file.string(), done.ticks, definition.rate, done.overruns, done.dropped,
             done.aborted_passes);
  return 0;
}

}  // namespace haptrial::experiments
