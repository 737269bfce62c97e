#pragma once

#include <cstdint>
#include <string>

#include "core/record/table/table.h"

namespace haptrial::record {

/// A key that was tuned while a pilot ran, a row of /tuning.
struct TuningRow {
  std::uint64_t sequence{0};  // of the first tick with the new value
  std::string key;            // path in the definition
  double before{0.0};         // in the key's unit
  double after{0.0};          // likewise
};

template <>
const Table<TuningRow>& table_of<TuningRow>();

}  // namespace haptrial::record
