#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "core/record/table/byte_planes.h"

namespace haptrial::record {

/// The columns that the analysis of a pass needs, doubles from the 32-bit values on file.
void get_column_i64(const BytePlanes& planes, std::size_t offset, std::size_t at,
                    std::span<std::int64_t> values);
/// @param stride  distance of consecutive results in `values` (3 fills one row of a 3 x n matrix).
void get_column_f32(const BytePlanes& planes, std::size_t offset, std::size_t at, std::size_t count,
                    double* values, std::size_t stride);

}  // namespace haptrial::record
