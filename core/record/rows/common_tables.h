#pragma once

#include "core/record/table/table_description.h"

namespace haptrial::record {

/// What a session of any protocol may have beside the tables of every session: answers, further
/// devices, what became of trials.
const TableList& common_tables();

}  // namespace haptrial::record
