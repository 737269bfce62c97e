#include "core/record/read/found_table.h"

#include <stdexcept>
#include <utility>

namespace haptrial::record {
namespace {

MemberType member_of(ColumnType type) {
  switch (type) {
    case ColumnType::kI32:
      return MemberType::kI32;
    case ColumnType::kI64:
      return MemberType::kI64;
    case ColumnType::kU64:
      return MemberType::kU64;
    case ColumnType::kF32:
      return MemberType::kF32;
    case ColumnType::kF64:
      return MemberType::kF64;
    case ColumnType::kText:
      return MemberType::kText;
    case ColumnType::kU8:
      break;
  }
  return MemberType::kU8;
}

std::vector<std::vector<Field>> fields_of(const h5::TableInFile& found) {
  std::vector<std::vector<Field>> fields;
  std::size_t offset = 0;
  for (const h5::ColumnInFile& column : found.columns) {
    fields.push_back({{{column.name.c_str(), column.type, column.bytes, column.unit.c_str(),
                        column.description.c_str(), column.resolution},
                       offset,
                       member_of(column.type)}});
    offset += column.bytes;
  }
  return fields;
}

std::size_t row_bytes(const h5::TableInFile& found) {
  std::size_t bytes = 0;
  for (const h5::ColumnInFile& column : found.columns) {
    bytes += column.bytes;
  }
  return bytes;
}

[[noreturn]] void no_other_layout(const TableDescription& table, const BytePlanes&, std::size_t,
                                  std::int64_t, BytePlanes&) {
  throw std::logic_error("/" + table.name() + " has one layout");
}

}  // namespace

FoundTable::FoundTable(h5::TableInFile found)
    : FoundTable(std::make_shared<const h5::TableInFile>(std::move(found))) {}

FoundTable::FoundTable(std::shared_ptr<const h5::TableInFile> found)
    : TableDescription({found->name.c_str(), found->description.c_str(), found->chunk_rows},
                       fields_of(*found), row_bytes(*found), &no_other_layout),
      found_(std::move(found)) {}

}  // namespace haptrial::record
