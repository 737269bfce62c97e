#include "core/record/table/table_page.h"

#include <fmt/format.h>

namespace haptrial::record {
namespace {

std::string type_of(const Column& column) {
  switch (column.type) {
    case ColumnType::kU8:
      return "u8";
    case ColumnType::kI32:
      return "i32";
    case ColumnType::kI64:
      return "i64";
    case ColumnType::kU64:
      return "u64";
    case ColumnType::kF32:
      return "f32";
    case ColumnType::kF64:
      return "f64";
    case ColumnType::kText:
      break;
  }
  return fmt::format("text {}", column.bytes);
}

}  // namespace

std::string page_of(const TableList& tables) {
  std::string page =
      "| Dataset | Column | Type | Unit | Meaning |\n| --- | --- | --- | --- | --- |\n";
  for (const TableDescription* table : tables) {
    bool first = true;
    for (const Field& field : table->fields()) {
      const std::string since = field.since > table->since()
                                    ? fmt::format(" (since schema version {})", field.since)
                                    : "";
      page +=
          fmt::format("| {} | `{}` | {} | {} | {}{} |\n", first ? "`/" + table->name() + "`" : "",
                      field.column.name, type_of(field.column), field.column.unit,
                      field.column.description, since);
      first = false;
    }
  }
  return page;
}

}  // namespace haptrial::record
