#pragma once

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <filesystem>
#include <mutex>
#include <string>
#include <thread>

#include "core/record/hdf5/hdf5_layer.h"

namespace haptrial::record {

/// Raised before a write was begun.
class NoSpace : public h5::Error {
 public:
  using h5::Error::Error;
};

/// Takes disk blocks ahead of the writes, so that a full disk is met here, where it can be told,
/// and not halfway through a write of HDF5, which cannot undo one.
class DiskSpace {
 public:
  /// Makes sure that `bytes` more, and a reserve for what HDF5 keeps in memory until it closes the
  /// file, fit behind the present end of the file.
  /// @throws NoSpace in the words of the system ("No space left on device").
  void ensure(int descriptor, std::uint64_t bytes);

 private:
  std::uint64_t reserved_end_{0};  // every block below is ours [bytes]
};

/// Writes the first bytes of the file over themselves. HDF5 frees a file that it cannot close and
/// yet keeps its identifier, so a device that takes no more writes must be met before.
/// @throws h5::Error in the words of the system.
void probe(int descriptor);

/// Points the descriptor at nothing in particular: writes succeed and are forgotten. After a failed
/// write this lets HDF5 close a file that it could otherwise never close.
void divert(int descriptor) noexcept;

/// Brings a file to the disk from a thread of its own, so that nobody waits for a slow disk, and
/// watches that the file is still where its name says. What was written before a sync began is safe
/// from a power cut when the sync has ended. The destructor waits for one that is under way.
class DiskSync {
 public:
  /// @param descriptor  of the file; outlives this
  /// @param path        where the file is to be found; outlives its renaming, not its moving
  DiskSync(int descriptor, std::filesystem::path path, std::chrono::milliseconds period);
  DiskSync(const DiskSync&) = delete;
  DiskSync& operator=(const DiskSync&) = delete;

  /// The next sync begins now, or when the present one has ended.
  void soon();
  /// The system's message when a sync failed; empty while none did.
  std::string failure() const;

  /// Whether the path still leads to the file, as of the last look (one before each sync).
  enum class Place { kThere, kMissing, kForeign };
  Place place() const noexcept { return place_.load(std::memory_order_relaxed); }

 private:
  void run(const std::stop_token& stop);

  int descriptor_;
  std::filesystem::path path_;
  std::chrono::milliseconds period_;
  std::atomic<Place> place_{Place::kThere};
  mutable std::mutex mutex_;  // the two below
  std::condition_variable_any wake_;
  bool asked_{false};
  std::string failure_;
  std::jthread thread_;  // last: it uses the others
};

/// Place of the file of a descriptor, seen from a path.
DiskSync::Place place_of(int descriptor, const std::filesystem::path& path) noexcept;

}  // namespace haptrial::record
