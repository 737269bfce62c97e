#pragma once

#include <atomic>
#include <chrono>
#include <cstddef>
#include <filesystem>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

namespace haptrial::experiments {

using CommandWords = std::vector<std::string>;  // after "haptrial"

/// A command line as a person types it: "haptrial validate 'my study.toml'".
std::string shown_command(const CommandWords& words);

struct CommandResult {
  int status{-1};      // exit status; -1: it was stopped
  std::string output;  // standard output and errors as they came
};

/// A command that goes on while pages come and go.
struct JobState {
  enum class State { kRunning, kDone, kFailed, kCancelled };
  enum class Kind { kWork, kSession };
  Kind kind{Kind::kWork};  // a session is asked to end before it is killed, so that it closes its
                           // file and takes the force away; one runs at a time
  int number{0};
  std::string command;  // as shown
  std::string study;    // the definition's name
  std::string folder;   // of the session files that it writes or analyses; may be empty
  int sessions{0};      // that it writes; 0: none
  State state{State::kRunning};
  int status{-1};
  double seconds{0.0};   // since the start, or from start to end
  std::size_t bytes{0};  // of its output so far
};

const char* name_of(JobState::State state) noexcept;

/// Runs this program's own commands as child processes in one folder, never by a shell. All that
/// still runs is ended at the end, with its process group. Any thread.
class Commands {
 public:
  /// @param program  the executable
  Commands(std::string program, std::filesystem::path folder);
  ~Commands();
  Commands(const Commands&) = delete;
  Commands& operator=(const Commands&) = delete;

  /// Runs a short command to its end. @throws RunError if it takes more than two minutes or cannot
  /// be started.
  CommandResult run(const CommandWords& words) const;
  /// Stops whatever run() waits for, for good.
  void stop() noexcept { stopped_ = true; }

  /// Starts a command that takes longer. @param about  study, folder and sessions
  /// @returns its number  @throws RunError if as many run as may, or another session runs.
  int start(const CommandWords& words, JobState about);
  std::vector<JobState> jobs() const;
  /// The last 200 kB of what a job printed. @throws InputError for a number that no job has.
  std::string output(int number) const;
  /// Ends a job with its group; nothing, if it has ended. @throws InputError as above
  void cancel(int number);

 private:
  struct Job;
  void work(Job& job, const CommandWords& words);
  Job& job(int number) const;
  void check_room_for(JobState::Kind kind) const;

  std::string program_;
  std::filesystem::path folder_;
  std::atomic<bool> stopped_{false};
  mutable std::mutex mutex_;
  std::vector<std::unique_ptr<Job>> jobs_;
};

}  // namespace haptrial::experiments
