#pragma once

#include <cstdint>

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

}  // namespace haptrial::record
