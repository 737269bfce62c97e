#include "core/record/rows/common_tables.h"

#include <algorithm>
#include <map>
#include <set>
#include <stdexcept>

#include "core/record/rows/answer_rows.h"
#include "core/record/rows/device_rows.h"
#include "core/record/rows/marker_row.h"
#include "core/record/rows/partner_rows.h"
#include "core/record/rows/session_tables.h"
#include "core/record/rows/trial_facts.h"

namespace haptrial::record {

const TableList& common_tables() {
  static const TableList tables{&responses_table(),      &table_of<DeviceRow>(),
                                &table_of<SkippedRow>(), &table_of<TakenBackRow>(),
                                &table_of<DampingRow>(), &table_of<MarkerRow>(),
                                &table_of<AnswerRow>(),  &table_of<TutoringRow>(),
                                &table_of<LinkRow>(),    &table_of<NetworkRow>()};
  return tables;
}

TableList with_tables(TableList tables, const TableList& more) {
  for (const TableDescription* table : more) {
    if (std::find(tables.begin(), tables.end(), table) == tables.end()) {
      tables.push_back(table);
    }
  }
  return tables;
}

namespace {

bool each_tick(const TableDescription& table) { return table.of() == RowsOf::kEachTick; }

/// Ticks do not rise from row to row where rows are taken for others.
bool told_by_ticks(const TableDescription& a, const TableDescription& b) {
  return each_tick(a) != each_tick(b) ||
         (each_tick(a) && a.schema().row_bytes() != b.schema().row_bytes());
}

}  // namespace

void check_chunk_sizes(const TableList& own) {
  std::set<const TableDescription*> tables(own.begin(), own.end());
  tables.insert(session_tables().begin(), session_tables().end());
  tables.insert(common_tables().begin(), common_tables().end());
  std::map<std::size_t, const TableDescription*> by_size;
  for (const TableDescription* table : tables) {
    const TableSchema& schema = table->schema();
    const std::size_t step = each_tick(*table) ? kLiveChunkStep : schema.chunk_rows;
    for (std::size_t rows = step; rows <= schema.chunk_rows; rows += step) {
      const auto [at, is_new] = by_size.emplace(rows * schema.row_bytes(), table);
      if (!is_new && !told_by_ticks(*at->second, *table)) {
        throw std::invalid_argument("the chunks of /" + at->second->name() + " and /" +
                                    table->name() +
                                    " may be of one size; choose another length for one of them");
      }
    }
  }
}

}  // namespace haptrial::record
