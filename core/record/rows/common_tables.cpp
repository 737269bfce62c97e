#include "core/record/rows/common_tables.h"

#include "core/record/rows/device_row.h"
#include "core/record/rows/response.h"

namespace haptrial::record {

const TableList& common_tables() {
  static const TableList tables{&responses_table(), &table_of<DeviceRow>()};
  return tables;
}

}  // namespace haptrial::record
