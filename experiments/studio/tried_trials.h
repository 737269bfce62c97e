#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "experiments/studio/commands.h"

namespace haptrial::experiments {

/// Trials that a pointer of a page tries: each is a command of the program that answers lines by
/// lines (`haptrial show --try`), as a child process. A new one ends the oldest if two run. All
/// that still run are killed at the end. Any thread.
class TriedTrials {
 public:
  static constexpr std::size_t kMostLines = 400;  // of a request

  /// @param program  the executable
  TriedTrials(std::string program, std::filesystem::path folder);
  ~TriedTrials();
  TriedTrials(const TriedTrials&) = delete;
  TriedTrials& operator=(const TriedTrials&) = delete;

  struct Begun {
    int number{0};      // 0: the command said no
    std::string first;  // line of the command; its sentences if it said no
  };
  /// Waits for the first line. @throws RunError if it cannot be started or takes two minutes
  Begun begin(const CommandWords& words);
  /// @param lines  without line ends @returns the answer to each
  /// @throws InputError for a number of none that runs, or for too many or too long lines;
  ///         RunError if it has ended
  std::vector<std::string> answer(int number, const std::vector<std::string>& lines);
  /// Ends one; nothing, if it has ended.
  void end(int number);

 private:
  class Child;
  std::shared_ptr<Child> child(int number) const;

  std::string program_;
  std::filesystem::path folder_;
  mutable std::mutex mutex_;
  int last_{0};
  std::map<int, std::shared_ptr<Child>> children_;
};

}  // namespace haptrial::experiments
