#pragma once

#include <filesystem>

namespace haptrial::record {

/// Keeps other processes from writing a file. The kernel gives the lock back when the process ends,
/// however it ends. Readers are not hindered: HDF5 locks files by other means (flock).
class FileLock {
 public:
  FileLock() = default;
  ~FileLock();
  FileLock(FileLock&& other) noexcept : descriptor_(other.descriptor_) { other.descriptor_ = -1; }
  FileLock& operator=(FileLock&& other) noexcept;

  /// Locks the file. @param create  it may be absent, and is then created empty.
  /// @throws InputError when another process, or another lock of this one, has it;
  ///         RunError when it cannot be opened.
  static FileLock take(const std::filesystem::path& file, bool create);
  /// Whether someone has the lock of this file; false for one that is absent.
  static bool taken(const std::filesystem::path& file);
  /// Whether nobody has the lock, and the file system has locks.
  static bool certainly_free(const std::filesystem::path& file);
  /// Descriptor of the locked file, or -1 if no file is locked.
  int descriptor() const { return descriptor_; }

 private:
  explicit FileLock(int descriptor) : descriptor_(descriptor) {}
  int descriptor_{-1};
};

}  // namespace haptrial::record
