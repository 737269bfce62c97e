#pragma once

#include <cstdint>
#include <mutex>
#include <stdexcept>

/// Handles of HDF5. Inside core/record only; hdf5.h stays in the source.
namespace haptrial::record::h5 {

/// Message of HDF5 or of the system; the callers add the file.
class Error : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Holds the one lock of the process for HDF5, which is not thread-safe in every installation, and
/// keeps its error printer quiet on this thread. Every function below takes it itself; may be
/// nested.
class Lock {
 public:
  Lock();

 private:
  std::unique_lock<std::recursive_mutex> hold_;
};

/// Owns one identifier of HDF5.
class Id {
 public:
  Id() = default;
  explicit Id(std::int64_t id) : id_(id) {}
  ~Id() { reset(); }
  Id(Id&& other) noexcept : id_(other.id_) { other.id_ = -1; }
  Id& operator=(Id&& other) noexcept;
  std::int64_t get() const { return id_; }
  explicit operator bool() const { return id_ >= 0; }
  /// @returns false when HDF5 could not close it; it is given up all the same.
  bool reset() noexcept;

 private:
  std::int64_t id_{-1};
};

}  // namespace haptrial::record::h5
