#include "analysis/exchange/channel_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <variant>

#include "analysis/quality/channel_quality.h"
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
                   Delimited kind, const WrittenSamples* ticks, GzipFile& file) {
  constexpr std::size_t kPiece = std::size_t{1} << 20;  // [bytes]
  const std::vector<ColumnDoc> docs = docs_of(table);
  const auto time =
      static_cast<std::size_t>(std::ranges::find(docs, "time_ns", &ColumnDoc::name) - docs.begin());
  std::string text = ticks == nullptr ? heading(docs, kind) : "";
  RowText row(text, kind);
  reader.each_row(table, [&](const std::vector<record::Cell>& cells) {
    if (ticks != nullptr) {
      row.add_seconds(ticks->even_time(std::get<std::int64_t>(cells.at(time))));
    }
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

std::vector<record::EventRow> channel_events(const record::SessionReader& reader, bool messages) {
  std::vector<record::EventRow> events;
  for (const channel::IncidentRow& row : analysis::channel_incidents(reader)) {
    const bool message = row.what == channel::Incident::kMessage;
    if (messages || !message) {
      // The amount of a message is how far its time may be wrong, no part of what was said.
      const bool amount = row.amount != 0.0 && !message;
      events.push_back({row.time_ns, fmt::format("channel_{}", channel::name_of(row.what)),
                        fmt::format("{}{}{}{}", row.channel, row.text.empty() ? "" : ": ", row.text,
                                    amount ? fmt::format(" ({:g})", row.amount) : "")});
    }
  }
  return events;
}

}  // namespace haptrial::exchange
