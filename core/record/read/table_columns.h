#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "core/record/table/byte_planes.h"

namespace haptrial::record {

class BytePlanes;
class TableDescription;

/// A column of a table, and the place for its values.
struct ColumnTarget {
  std::size_t field{0};           // of TableDescription::fields()
  std::uint8_t* values{nullptr};  // (rows x bytes of the column), as the file has them, aligned
};

/// Rows of a result.
struct RowRange {
  std::size_t first;
  std::size_t count;
};

/// Columns of a chunk in the present layout, from its row `at` on, into the rows `to` of targets.
void get_columns(const TableDescription& table, const BytePlanes& planes, std::size_t at,
                 const RowRange& to, std::span<const ColumnTarget> targets);

/// The columns that the analysis of a pass needs, doubles from the 32-bit values on file.
void get_column_i64(const BytePlanes& planes, std::size_t offset, std::size_t at,
                    std::span<std::int64_t> values);
/// @param stride  distance of consecutive results in `values` (3 fills one row of a 3 x n matrix).
void get_column_f32(const BytePlanes& planes, std::size_t offset, std::size_t at, std::size_t count,
                    double* values, std::size_t stride);

}  // namespace haptrial::record
