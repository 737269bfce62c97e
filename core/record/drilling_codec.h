#pragma once

#include <cstddef>

#include "core/record/byte_planes.h"
#include "core/record/drilling_types.h"
#include "core/record/schema.h"

namespace haptrial::record {

/// The table that a row type belongs to, one specialisation for each type of drilling_types.h.
template <class Row>
DrillingTable table_of();

/// Rows to and from the planes of a chunk, in the column order of the table's schema.
/// @throws std::invalid_argument for a text that does not fit its column or holds a NUL byte.
template <class Row>
void put_row(BytePlanes& planes, std::size_t at, const Row& row);
template <class Row>
Row get_row(const BytePlanes& planes, std::size_t at);

}  // namespace haptrial::record
