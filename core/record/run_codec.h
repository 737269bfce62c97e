#pragma once

#include <cstddef>

#include "core/record/byte_planes.h"
#include "core/record/run_types.h"

namespace haptrial::record {

/// Rows of /runs and /begun to and from the planes of a chunk, in the column order of schema.h.
/// @throws std::invalid_argument for a text that does not fit its column or holds a NUL byte.
void put_run(BytePlanes& planes, std::size_t at, const RunRow& row);
void put_begun(BytePlanes& planes, std::size_t at, const BegunRow& row);

RunRow get_run(const BytePlanes& planes, std::size_t at);
BegunRow get_begun(const BytePlanes& planes, std::size_t at);

}  // namespace haptrial::record
