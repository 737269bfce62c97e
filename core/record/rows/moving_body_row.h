#pragma once

#include <cstdint>
#include <string>

#include "core/record/table/table.h"

namespace haptrial::record {

/// How a body that moves did so in a pass, a row of /moving_bodies. Counts are ticks.
struct MovingBodyRow {
  std::int32_t pass{0};          // row of /trials
  std::int32_t device{0};        // whose tool, from 0
  std::string object;            // its name
  std::int32_t steps{0};         // of the body on a tick
  std::uint64_t limited{0};      // the force was cut, or it might have given out energy
  std::uint64_t flown_apart{0};  // it flew apart and was put to rest
};

template <>
const Table<MovingBodyRow>& table_of<MovingBodyRow>();

}  // namespace haptrial::record
