#include "core/record/table/cells.h"

#include <cstring>

#include "core/record/table/field_codec.h"

namespace haptrial::record {
namespace {

Cell cell_of(const Column& column, const std::uint8_t* bytes) {
  switch (column.type) {
    case ColumnType::kU8:
      return std::int64_t{*bytes};
    case ColumnType::kI32:
      return std::int64_t{value_at<std::int32_t>(bytes, 0, 0)};
    case ColumnType::kI64:
      return value_at<std::int64_t>(bytes, 0, 0);
    case ColumnType::kU64:
      return value_at<std::uint64_t>(bytes, 0, 0);
    case ColumnType::kF32:
      return value_at<float>(bytes, 0, 0);
    case ColumnType::kF64:
      return value_at<double>(bytes, 0, 0);
    case ColumnType::kText:
      break;
  }
  const auto* text = reinterpret_cast<const char*>(bytes);
  return std::string(text, strnlen(text, column.bytes));
}

}  // namespace

std::vector<Cell> cells_of(const TableSchema& schema, std::span<const std::uint8_t> packed) {
  std::vector<Cell> cells;
  std::size_t at = 0;
  for (const Column& column : schema.columns) {
    cells.push_back(cell_of(column, packed.data() + at));
    at += column.bytes;
  }
  return cells;
}

}  // namespace haptrial::record
