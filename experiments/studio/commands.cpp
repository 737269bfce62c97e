#include "experiments/studio/commands.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "core/base/child_process.h"
#include "core/base/error.h"
#include "core/base/exception_words.h"
#include "core/base/shell_word.h"

namespace haptrial::experiments {
namespace {

using Clock = std::chrono::steady_clock;

constexpr std::size_t kMostOutput = 4'000'000;  // of a command [bytes]; the rest is left out
constexpr std::chrono::minutes kLongest(2);     // of run()
constexpr int kMostRunning = 4;                 // jobs at a time
constexpr std::size_t kMostJobs = 500;          // in one run of the studio
constexpr std::chrono::seconds kToEnd(15);      // for a session that is asked to end

double seconds_between(Clock::time_point from, Clock::time_point to) {
  return std::chrono::duration<double>(to - from).count();
}

/// Runs a program until it ends or `go_on` says no; then it is killed with its group.
/// @param patience  with a program that was asked to end; 0: it is killed without being asked
/// @returns its exit status, -1 after a kill
int run_program(const std::string& program, const CommandWords& words,
                const std::filesystem::path& folder,
                const std::function<bool(std::string_view)>& take,
                const std::function<bool()>& go_on,
                Clock::duration patience = Clock::duration::zero()) {
  Pipe pipe;
  Program started{.words = {program}, .folder = folder, .output = pipe.to.get()};
  started.words.insert(started.words.end(), words.begin(), words.end());
  ChildProcess child(started);
  pipe.to.close();
  bool stopped = false;
  read_pieces(pipe.from.get(), take, [&] {
    stopped = !go_on();
    return !stopped;
  });
  if (stopped) {
    const auto last = Clock::now() + patience;
    if (patience > Clock::duration::zero()) {
      child.ask_to_end();
      read_pieces(pipe.from.get(), take, [&] { return Clock::now() < last; });
    }
    if (Clock::now() >= last) {
      child.kill();
    }
  }
  return child.wait();
}

}  // namespace

std::string shown_command(const CommandWords& words) {
  std::string line = "haptrial";
  for (const std::string& word : words) {
    line += " " + shell_word(word);
  }
  return line;
}

const char* name_of(JobState::State state) noexcept {
  switch (state) {
    case JobState::State::kRunning:
      return "running";
    case JobState::State::kDone:
      return "done";
    case JobState::State::kCancelled:
      return "cancelled";
    case JobState::State::kFailed:
      break;
  }
  return "failed";
}

struct Commands::Job {
  JobState state;
  std::string output;
  Clock::time_point start{Clock::now()};
  std::atomic<bool> cancelled{false};
  std::thread thread;
};

Commands::Commands(std::string program, std::filesystem::path folder)
    : program_(std::move(program)), folder_(std::move(folder)) {}

Commands::~Commands() {
  stop();
  for (const auto& job : jobs_) {
    job->thread.join();
  }
}

CommandResult Commands::run(const CommandWords& words) const {
  CommandResult result;
  const auto start = Clock::now();
  const auto take = [&](std::string_view piece) {
    result.output += piece.substr(0, kMostOutput - std::min(kMostOutput, result.output.size()));
    return true;
  };
  const auto in_time = [&] { return !stopped_ && Clock::now() - start < kLongest; };
  try {
    result.status = run_program(program_, words, folder_, take, in_time);
  } catch (const std::system_error& error) {
    throw RunError(
        fmt::format("{} cannot be started: {}", shown_command(words), error.code().message()));
  }
  if (!in_time()) {
    throw RunError(fmt::format("{} took too long and was stopped", shown_command(words)));
  }
  return result;
}

int Commands::start(const CommandWords& words, JobState about) {
  const std::lock_guard lock(mutex_);
  check_room_for(about.kind);
  auto job = std::make_unique<Job>();
  job->state = std::move(about);
  job->state.number = static_cast<int>(jobs_.size()) + 1;
  job->state.command = shown_command(words);
  Job& kept = *jobs_.emplace_back(std::move(job));
  kept.thread = std::thread([this, &kept, words] { work(kept, words); });
  return kept.state.number;
}

void Commands::work(Job& job, const CommandWords& words) {
  const auto take = [&](std::string_view piece) {
    const std::lock_guard lock(mutex_);
    job.output += piece.substr(0, kMostOutput - std::min(kMostOutput, job.output.size()));
    return true;
  };
  int status = -1;
  std::string failure;
  try {
    status = run_program(
        program_, words, folder_, take, [&] { return !stopped_ && !job.cancelled; },
        job.state.kind == JobState::Kind::kSession ? kToEnd : Clock::duration::zero());
  } catch (const std::exception& error) {
    failure = sentence_of(error) + "\n";
  }
  const std::lock_guard lock(mutex_);
  job.output += failure;
  job.state.status = status;
  job.state.seconds = seconds_between(job.start, Clock::now());
  job.state.state = job.cancelled && status != 0 ? JobState::State::kCancelled
                    : status == 0                ? JobState::State::kDone
                                                 : JobState::State::kFailed;
}

void Commands::check_room_for(JobState::Kind kind) const {
  int running = 0;
  for (const auto& job : jobs_) {
    const bool runs = job->state.state == JobState::State::kRunning;
    running += runs ? 1 : 0;
    if (runs && kind == JobState::Kind::kSession && job->state.kind == kind) {
      throw RunError("a session is running already; end it before another begins");
    }
  }
  if (running >= kMostRunning) {
    throw RunError(
        fmt::format("{} jobs are running already; wait for one, or cancel it", kMostRunning));
  }
  if (jobs_.size() >= kMostJobs) {
    throw RunError(fmt::format("{} jobs were started; start the studio anew", kMostJobs));
  }
}

std::vector<JobState> Commands::jobs() const {
  const std::lock_guard lock(mutex_);
  std::vector<JobState> all;
  for (const auto& job : jobs_) {
    JobState state = job->state;
    state.bytes = job->output.size();
    if (state.state == JobState::State::kRunning) {
      state.seconds = seconds_between(job->start, Clock::now());
    }
    all.push_back(std::move(state));
  }
  return all;
}

Commands::Job& Commands::job(int number) const {
  if (number < 1 || number > static_cast<int>(jobs_.size())) {
    throw InputError(fmt::format("there is no job {}; allowed: 1 to {}", number, jobs_.size()));
  }
  return *jobs_[static_cast<std::size_t>(number) - 1];
}

std::string Commands::output(int number) const {
  constexpr std::size_t kShown = 200'000;
  const std::lock_guard lock(mutex_);
  const std::string& all = job(number).output;
  return all.substr(all.size() - std::min(kShown, all.size()));
}

void Commands::cancel(int number) {
  const std::lock_guard lock(mutex_);
  job(number).cancelled = true;
}

}  // namespace haptrial::experiments
