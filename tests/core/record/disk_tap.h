#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

namespace haptrial::test {

/// One step of a file on its way to the disk.
struct DiskStep {
  enum Kind { kWrite, kTruncate, kSyncBegins, kSyncEnds, kMark } kind{kWrite};
  std::uint64_t offset{0};  // of a write; the length after a truncation; the number of a mark
  std::string bytes;        // of a write
};

/// Sees what this program writes to one file: pwrite, ftruncate, fsync and fdatasync are defined
/// here, for our objects and for the library of HDF5 alike.
class DiskTap {
 public:
  /// Records, from now on, every step of the file of this name or of one that it gets later.
  static void start(const std::string& path);
  static void mark(std::uint64_t number);
  static std::vector<DiskStep> stop();

  /// Sets a callback before each write, truncation, sync and renaming of any file; null: no more.
  /// For one thread.
  static void before_each(std::function<void()> step);
  /// Sets a function in the place of fdatasync(), on whatever thread; null: the system's own.
  static void instead_of_fdatasync(std::function<int(int)> sync);
};

}  // namespace haptrial::test
