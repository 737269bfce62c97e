#pragma once

#include <cstdint>
#include <string>

#include "core/record/table/table.h"

namespace haptrial::record {

/// The network that a pass of a dry run went over, a row of /networks. Each way.
struct NetworkRow {
  std::int32_t pass{0};  // row of /trials
  std::string name;      // as the definition calls it
  double delay{0.0};     // least [s]
  double jitter{0.0};    // mean of what comes on top [s]
  double loss{0.0};      // share
  double duplication{0.0};
  double reordering{0.0};
  double bandwidth{0.0};  // [bytes/s]; 0: no limit
};

template <>
const Table<NetworkRow>& table_of<NetworkRow>();

}  // namespace haptrial::record
