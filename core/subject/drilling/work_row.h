#pragma once

#include <cstdint>
#include <string_view>

#include "core/record/table/table.h"
#include "core/subject/drilling/surgeon_work.h"

namespace haptrial::record {

/// Work that a virtual surgeon began, a row of /work.
struct WorkRow {
  std::int32_t pass{0};  // row of /trials
  double time{0.0};      // of the procedure, earlier passes on its bone included [s]
  subject::SurgeonWork work{subject::SurgeonWork::kCortex};
};

/// "cortex", "fine burr".
std::string_view word_of(subject::SurgeonWork work) noexcept;

template <>
const Table<WorkRow>& table_of<WorkRow>();

}  // namespace haptrial::record
