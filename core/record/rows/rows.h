#pragma once

#include <cstddef>
#include <span>

#include "core/record/table/table.h"

namespace haptrial::record {

/// Rows of one table, contiguous, on their way from a log to the sinks.
struct Rows {
  template <class Row>
  explicit Rows(std::span<const Row> rows)
      : table(&table_of<Row>()), data(rows.data()), count(rows.size()) {}
  Rows(const TableDescription& of, const void* first, std::size_t rows)
      : table(&of), data(first), count(rows) {}

  /// The rows as their type; none if they are of another table.
  template <class Row>
  std::span<const Row> as() const {
    return table == &table_of<Row>() ? std::span(static_cast<const Row*>(data), count)
                                     : std::span<const Row>{};
  }

  const TableDescription* table;
  const void* data;
  std::size_t count;
};

}  // namespace haptrial::record
