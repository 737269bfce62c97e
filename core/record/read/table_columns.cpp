#include "core/record/read/table_columns.h"

#include <algorithm>
#include <array>
#include <bit>

#include "core/record/table/table_description.h"

namespace haptrial::record {
namespace {

/// Numbers of one width.
template <class T>
void get_numbers(const BytePlanes& planes, std::size_t offset, std::size_t at, std::size_t count,
                 std::uint8_t* to) {
  constexpr std::size_t kInCache = 1024;  // values that stay in the first-level cache
  auto* values = reinterpret_cast<T*>(to);
  for (std::size_t i = 0; i < count; i += kInCache) {
    planes.get_column<T>(offset, at + i, std::span(values + i, std::min(kInCache, count - i)));
  }
}

void get_texts(const BytePlanes& planes, std::size_t offset, std::size_t at, std::size_t count,
               std::uint8_t* to, std::size_t bytes) {
  for (std::size_t b = 0; b < bytes; ++b) {
    const std::uint8_t* plane = planes.bytes().data() + (offset + b) * planes.capacity() + at;
    for (std::size_t i = 0; i < count; ++i) {
      to[i * bytes + b] = plane[i];
    }
  }
}

}  // namespace

void get_columns(const TableDescription& table, const BytePlanes& planes, std::size_t at,
                 const RowRange& to, std::span<const ColumnTarget> targets) {
  for (const ColumnTarget& target : targets) {
    const Column& column = table.fields().at(target.field).column;
    const std::size_t offset = table.schema().offset(column.name);
    std::uint8_t* values = target.values + to.first * column.bytes;
    if (column.type == ColumnType::kText) {
      get_texts(planes, offset, at, to.count, values, column.bytes);
    } else if (column.bytes == sizeof(std::uint64_t)) {
      get_numbers<std::uint64_t>(planes, offset, at, to.count, values);
    } else if (column.bytes == sizeof(std::uint32_t)) {
      get_numbers<std::uint32_t>(planes, offset, at, to.count, values);
    } else {
      get_numbers<std::uint8_t>(planes, offset, at, to.count, values);
    }
  }
}

namespace {

// Rows are split in batches that stay in the first-level cache.
constexpr std::size_t kBatch = 256;

}  // namespace

void get_column_i64(const BytePlanes& planes, std::size_t offset, std::size_t at,
                    std::span<std::int64_t> values) {
  std::array<std::uint64_t, kBatch> bits;
  for (std::size_t i = 0; i < values.size(); i += kBatch) {
    const std::size_t count = std::min(kBatch, values.size() - i);
    planes.get_column<std::uint64_t>(offset, at + i, std::span(bits.data(), count));
    for (std::size_t k = 0; k < count; ++k) {
      values[i + k] = static_cast<std::int64_t>(bits[k]);
    }
  }
}

void get_column_f32(const BytePlanes& planes, std::size_t offset, std::size_t at, std::size_t count,
                    double* values, std::size_t stride) {
  std::array<std::uint32_t, kBatch> bits;
  for (std::size_t i = 0; i < count; i += kBatch) {
    const std::size_t n = std::min(kBatch, count - i);
    planes.get_column<std::uint32_t>(offset, at + i, std::span(bits.data(), n));
    for (std::size_t k = 0; k < n; ++k) {
      values[(i + k) * stride] = static_cast<double>(std::bit_cast<float>(bits[k]));
    }
  }
}

}  // namespace haptrial::record
