#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "experiments/studio/commands.h"

namespace haptrial::experiments {

/// Commands of the program that answer lines by lines (`haptrial show --try`, `--pages`), each as a
/// child process. A new one ends the oldest if two run. All that still run are killed at the end.
/// Any thread.
class LineCommands {
 public:
  /// @param program  the executable
  LineCommands(std::string program, std::filesystem::path folder);
  ~LineCommands();
  LineCommands(const LineCommands&) = delete;
  LineCommands& operator=(const LineCommands&) = delete;

  struct StartedCommand {
    int number{0};      // 0: the command said no
    std::string first;  // line of the command; its sentences if it said no
  };
  /// Waits for the first line, which begins with '{'. @throws RunError if it cannot be started or
  /// takes two minutes
  StartedCommand begin(const CommandWords& words);
  /// @param lines  without line ends  @returns the answer to each
  /// @throws InputError for a number of none that runs; RunError if it has ended
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
