#include "core/record/rows/common_tables.h"

#include "core/record/rows/device_row.h"
#include "core/record/rows/response.h"
#include "core/record/rows/trial_facts.h"

namespace haptrial::record {

const TableList& common_tables() {
  static const TableList tables{&responses_table(), &table_of<DeviceRow>(), &table_of<SkippedRow>(),
                                &table_of<DampingRow>()};
  return tables;
}

}  // namespace haptrial::record
