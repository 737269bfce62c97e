#include "core/record/read/table_columns.h"

#include <algorithm>

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

}  // namespace haptrial::record
