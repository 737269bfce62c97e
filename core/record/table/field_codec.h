#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <string>

#include "core/record/table/byte_planes.h"
#include "core/record/table/field.h"

namespace haptrial::record {

/// Rows go through the codec in batches that stay in the first-level cache.
inline constexpr std::size_t kBatch = 256;

/// A column in the planes of a chunk, and a row of it.
struct Place {
  std::size_t offset;  // of the column within the packed row [bytes]
  std::size_t row;
};

/// The members of `count` rows, at most kBatch, of which the first is at `members` and each
/// follows `stride` bytes after the one before. Texts and words were checked.
void put_field(const Field& field, BytePlanes& planes, Place to, const std::uint8_t* members,
               std::size_t stride, std::size_t count);
/// @throws UnknownWord naming the table
void get_field(const std::string& table, const Field& field, const BytePlanes& planes, Place from,
               std::uint8_t* members, std::size_t stride, std::size_t count);
std::string get_text(const BytePlanes& planes, Place from, std::size_t bytes);

/// A member of row i, from the address of the member in row 0.
template <class T>
T value_at(const std::uint8_t* members, std::size_t stride, std::size_t i) {
  T value;
  std::memcpy(&value, members + i * stride, sizeof(T));
  return value;
}

}  // namespace haptrial::record
