#pragma once

#include <cstdint>
#include <string>

#include "core/record/table/table.h"

namespace haptrial::record {

/// A part of a device that the session drives, a row of /arms. Those of a rotation are recorded as
/// the arc that fingers travel which hold it at `radius`, and the force along it.
struct ArmRow {
  std::int32_t device{0};  // as in /devices; 0 is that of /samples
  std::string name;        // in the definition
  std::string part;        // "tip", "rotation" or "grip"
  std::int32_t of{0};      // the device whose part it is, as above
  double radius{1.0};      // of a rotation [m]
};

/// The table exists in sessions that drive a rotation or a grip.
template <>
const Table<ArmRow>& table_of<ArmRow>();

}  // namespace haptrial::record
