#include "analysis/exchange/channel_text.h"

#include <string>
#include <variant>

#include "core/record/read/session_reader.h"
#include "core/record/table/table_description.h"

namespace haptrial::exchange {

std::vector<ColumnDoc> docs_of(const record::TableDescription& table) {
  std::vector<ColumnDoc> docs;
  for (const record::Column& column : table.schema().columns) {
    docs.push_back(doc_of(table.schema(), column.name));
  }
  return docs;
}

void write_channel(const record::SessionReader& reader, const record::TableDescription& table,
                   Delimited kind, bool headed, GzipFile& file) {
  constexpr std::size_t kPiece = std::size_t{1} << 20;  // [bytes]
  std::string text = headed ? heading(docs_of(table), kind) : "";
  RowText row(text, kind);
  reader.each_row(table, [&](const std::vector<record::Cell>& cells) {
    for (const record::Cell& cell : cells) {
      std::visit([&](const auto& value) { row.add(value); }, cell);
    }
    row.end();
    if (text.size() >= kPiece) {
      file.write(text);
      text.clear();
    }
  });
  file.write(text);
}

}  // namespace haptrial::exchange
