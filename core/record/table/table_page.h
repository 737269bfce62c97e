#pragma once

#include <string>

#include "core/record/table/table_description.h"

namespace haptrial::record {

/// The tables as docs/session-file.md shows them: a table in Markdown with one row a column.
std::string page_of(const TableList& tables);

}  // namespace haptrial::record
