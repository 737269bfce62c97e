#pragma once

#include "core/record/table/table_description.h"

namespace haptrial::record {

/// Tables that a session of any protocol may have beside those of every session: answers, further
/// devices, outcomes of trials, markers.
const TableList& common_tables();

/// `tables` and after them those of `more` that are not among them.
TableList with_tables(TableList tables, const TableList& more);

/// Recovery knows whose a chunk is by its inflated size, and of tables with a row for each tick by
/// their ticks.
/// @param own  tables of protocols
/// @throws std::invalid_argument naming two tables, of these and those of every session, whose
/// chunks may be of one size; another number of rows in a chunk mends it
void check_chunk_sizes(const TableList& own);

}  // namespace haptrial::record
