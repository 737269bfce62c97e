#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

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

}  // namespace haptrial::record
