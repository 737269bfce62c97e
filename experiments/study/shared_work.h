#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

namespace haptrial::experiments {

/// Says to other processes, on this machine or on others that see the folder, which units are under
/// way here: a lock on one byte of a file for each unit. The system releases the locks of a process
/// that dies. If the file system has no locks every unit counts as free, and some are made twice,
/// with the same bytes. Any thread.
class UnitLocks {
 public:
  /// @param file  made if it is not there
  explicit UnitLocks(const std::filesystem::path& file);
  ~UnitLocks();
  UnitLocks(const UnitLocks&) = delete;
  UnitLocks& operator=(const UnitLocks&) = delete;

  /// Whether no other process has the unit; it is this one's then. Does not wait.
  bool take(std::size_t unit) const;
  void release(std::size_t unit) const;

 private:
  int file_{-1};
};

/// The unit of a process while this lives.
class TakenUnit {
 public:
  TakenUnit(const UnitLocks& locks, std::size_t unit)
      : locks_(locks), unit_(unit), taken_(locks.take(unit)) {}
  ~TakenUnit() {
    if (taken_) {
      locks_.release(unit_);
    }
  }
  TakenUnit(const TakenUnit&) = delete;
  TakenUnit& operator=(const TakenUnit&) = delete;
  explicit operator bool() const { return taken_; }

 private:
  const UnitLocks& locks_;
  std::size_t unit_;
  bool taken_;
};

/// Which of several like processes this one is.
struct LaunchRank {
  int rank{0};
  int size{1};
};

/// Rank that mpirun (OpenMPI, MPICH) or srun told this process by its environment; nothing: it was
/// started alone. @param variable  value of an environment variable, or null
std::optional<LaunchRank> launch_rank(const std::function<const char*(const char*)>& variable);
std::optional<LaunchRank> launch_rank();

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
