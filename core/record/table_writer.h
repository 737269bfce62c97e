#pragma once

#include <cstdint>
#include <functional>

#include "core/record/byte_planes.h"
#include "core/record/deflate.h"
#include "core/record/hdf5_layer.h"
#include "core/record/schema.h"

namespace haptrial::record {

/// Collects the rows of one dataset in its present chunk and hands finished chunks to the file.
/// Compression runs outside of the lock of HDF5.
class TableWriter {
 public:
  using EnsureSpace = std::function<void(std::uint64_t bytes)>;

  /// Creates the dataset. @param ensure_space  called before each write to the file.
  TableWriter(const h5::Id& file, const TableSchema& schema, EnsureSpace ensure_space);

  /// Where the next rows go: rows [used(), used() + room()) of the chunk; then say how many.
  BytePlanes& planes() { return planes_; }
  std::size_t used() const { return used_; }
  std::size_t room() const { return planes_.capacity() - used_; }
  void added(std::size_t rows);

  /// Writes the rows of the unfinished chunk, padded with zeros; more may follow them.
  void write_unfinished();

  const h5::Id& dataset() const { return dataset_; }
  void close() noexcept { dataset_.reset(); }

 private:
  void write();

  h5::Id dataset_;
  EnsureSpace ensure_space_;
  BytePlanes planes_;
  Deflater deflater_;
  std::uint64_t first_row_{0};  // of the present chunk
  std::size_t used_{0};
  std::size_t written_{0};  // rows of the present chunk that are in the file
};

}  // namespace haptrial::record
