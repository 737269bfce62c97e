#pragma once

#include <cstddef>
#include <filesystem>

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

}  // namespace haptrial::experiments
