#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <mutex>
#include <string>
#include <vector>

#include "experiments/study/unit_locks.h"

namespace haptrial::experiments {

/// A folder whose session files are the state of a dry run: any number of processes may fill it at
/// once, and the same command again runs what is missing. dry-run.toml says what dry run it is.
class DryParts {
 public:
  /// Makes the folder, or goes on with one.
  /// @param what  everything on which sessions depend; the same text: the same sessions
  /// @throws InputError for a folder of something else, or that cannot be written
  DryParts(const std::filesystem::path& folder, const std::string& what);

  /// Calls run() unless the session is there or another process runs it. What is left of one that
  /// was killed is removed before. Any thread. @param number  of the session in the dry run
  void run(std::size_t number, const std::filesystem::path& file, const std::function<void()>& run);

  /// The numbers of those that other processes ran meanwhile, and forgets them.
  std::vector<std::size_t> elsewhere();

 private:
  UnitLocks locks_;
  std::mutex mutex_;
  std::vector<std::size_t> elsewhere_;
};

}  // namespace haptrial::experiments
