#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace haptrial::record {

/// The rows of one chunk as the shuffle filter of HDF5 leaves them: byte b of every row, then byte
/// b + 1 of every row. Rows are written here directly, so that nothing is transposed twice.
///
///     bytes()[b * capacity + row] = byte b of row
class BytePlanes {
 public:
  BytePlanes(std::size_t row_bytes, std::size_t capacity);

  std::size_t row_bytes() const { return row_bytes_; }
  std::size_t capacity() const { return capacity_; }  // [rows]
  std::uint8_t* data() { return bytes_.data(); }
  std::span<const std::uint8_t> bytes() const { return bytes_; }

  /// Writes or reads one packed row of row_bytes() bytes.
  void put_row(std::size_t row, std::span<const std::uint8_t> packed);
  void get_row(std::size_t row, std::span<std::uint8_t> packed) const;

  /// Writes or reads `values.size()` consecutive values of the column that starts at byte `offset`
  /// of the row, from `row` on. T: an unsigned integer of the column's width.
  template <typename T>
  void put_column(std::size_t offset, std::size_t row, std::span<const T> values);
  template <typename T>
  void get_column(std::size_t offset, std::size_t row, std::span<T> values) const;

  /// How many rows there are without the zeros behind them. Rows differ in their keys, so that only
  /// the first one of a table may be all zeros: /field of a first pass without blood or heat.
  std::size_t rows_in_use() const;

  /// Zeroes the rows from `row` on, so that the padding of a chunk is always the same.
  void clear_from(std::size_t row);

 private:
  std::size_t row_bytes_;
  std::size_t capacity_;
  std::vector<std::uint8_t> bytes_;
};

}  // namespace haptrial::record
