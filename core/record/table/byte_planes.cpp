#include "core/record/table/byte_planes.h"

#include <algorithm>
#include <bit>

namespace haptrial::record {

static_assert(std::endian::native == std::endian::little, "rows are packed little-endian");

BytePlanes::BytePlanes(std::size_t row_bytes, std::size_t capacity)
    : row_bytes_(row_bytes), capacity_(capacity), bytes_(row_bytes * capacity) {}

void BytePlanes::put_row(std::size_t row, std::span<const std::uint8_t> packed) {
  for (std::size_t b = 0; b < row_bytes_; ++b) {
    bytes_[b * capacity_ + row] = packed[b];
  }
}

void BytePlanes::get_row(std::size_t row, std::span<std::uint8_t> packed) const {
  for (std::size_t b = 0; b < row_bytes_; ++b) {
    packed[b] = bytes_[b * capacity_ + row];
  }
}

template <typename T>
void BytePlanes::put_column(std::size_t offset, std::size_t row, std::span<const T> values) {
  for (std::size_t b = 0; b < sizeof(T); ++b) {
    std::uint8_t* const __restrict plane = bytes_.data() + (offset + b) * capacity_ + row;
    const T* const __restrict from = values.data();
    for (std::size_t i = 0; i < values.size(); ++i) {
      plane[i] = static_cast<std::uint8_t>(from[i] >> (8 * b));
    }
  }
}

template <typename T>
void BytePlanes::get_column(std::size_t offset, std::size_t row, std::span<T> values) const {
  T* const __restrict to = values.data();
  std::fill(values.begin(), values.end(), T{0});
  for (std::size_t b = 0; b < sizeof(T); ++b) {
    const std::uint8_t* const __restrict plane = bytes_.data() + (offset + b) * capacity_ + row;
    for (std::size_t i = 0; i < values.size(); ++i) {
      to[i] = static_cast<T>(to[i] | static_cast<T>(static_cast<T>(plane[i]) << (8 * b)));
    }
  }
}

std::size_t BytePlanes::rows_in_use() const {
  const auto is_zero = [&](std::size_t row) {
    for (std::size_t b = 0; b < row_bytes_; ++b) {
      if (bytes_[b * capacity_ + row] != 0) {
        return false;
      }
    }
    return true;
  };
  std::size_t rows = capacity_;
  while (rows > 0 && is_zero(rows - 1)) {
    --rows;
  }
  return rows;
}

void BytePlanes::clear_from(std::size_t row) {
  for (std::size_t b = 0; b < row_bytes_; ++b) {
    std::fill(bytes_.begin() + static_cast<std::ptrdiff_t>(b * capacity_ + row),
              bytes_.begin() + static_cast<std::ptrdiff_t>((b + 1) * capacity_), std::uint8_t{0});
  }
}

template void BytePlanes::put_column(std::size_t, std::size_t, std::span<const std::uint8_t>);
template void BytePlanes::put_column(std::size_t, std::size_t, std::span<const std::uint32_t>);
template void BytePlanes::put_column(std::size_t, std::size_t, std::span<const std::uint64_t>);
template void BytePlanes::get_column(std::size_t, std::size_t, std::span<std::uint8_t>) const;
template void BytePlanes::get_column(std::size_t, std::size_t, std::span<std::uint32_t>) const;
template void BytePlanes::get_column(std::size_t, std::size_t, std::span<std::uint64_t>) const;

}  // namespace haptrial::record
