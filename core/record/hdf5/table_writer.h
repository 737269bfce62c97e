#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <type_traits>

#include "core/record/hdf5/deflate.h"
#include "core/record/hdf5/hdf5_layer.h"
#include "core/record/table/byte_planes.h"
#include "core/record/table/table.h"

namespace haptrial::record {

/// Collects the rows of one dataset in its present chunk and hands finished chunks to the file.
/// Compression runs outside of the lock of HDF5.
class TableWriter {
 public:
  using EnsureSpace = std::function<void(std::uint64_t bytes)>;

  /// Creates the dataset. @param ensure_space  called before each write to the file.
  /// @param level  of compression, 1 (fast) to 12
  TableWriter(const h5::Id& file, const TableSchema& schema, int level, EnsureSpace ensure_space);

  /// Opens the dataset to go on after its last row.
  /// @throws h5::Error when the chunk to go on in cannot be read.
  static TableWriter go_on(const h5::Id& file, const TableSchema& schema, int level,
                           EnsureSpace ensure_space);

  /// Buffer of the next rows: rows [used(), used() + room()) of the chunk; then say how many.
  BytePlanes& planes() { return planes_; }
  std::size_t used() const { return used_; }
  std::size_t room() const { return planes_.capacity() - used_; }
  void added(std::size_t rows);

  /// Adds rows of the table that it writes. @throws as TableDescription::put()
  void add(const TableDescription& table, const void* rows, std::size_t count);
  template <class Row>
  void add(const Table<Row>& table, const std::type_identity_t<std::span<const Row>>& rows) {
    add(table, rows.data(), rows.size());
  }

  /// Writes the rows of the unfinished chunk, padded with zeros; more may follow them.
  void write_unfinished();
  std::uint64_t rows() const { return first_row_ + used_; }  // of the dataset
  bool has_unwritten() const { return used_ != written_; }

  const h5::Id& dataset() const { return dataset_; }
  void close() noexcept { dataset_.reset(); }

 private:
  TableWriter(h5::Id dataset, const TableSchema& schema, std::size_t chunk_rows, int level,
              EnsureSpace ensure_space);
  void write();

  h5::Id dataset_;
  EnsureSpace ensure_space_;
  BytePlanes planes_;
  Deflater deflater_;
  std::uint64_t first_row_{0};  // of the present chunk
  std::size_t used_{0};
  std::size_t written_{0};        // rows of the present chunk that are in the file
  std::size_t written_bytes_{0};  // that they take there
};

}  // namespace haptrial::record
