#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "core/record/rows/session_types.h"
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

/// One who takes what a session records: the file, a stream, live figures. All sinks get the same,
/// in the same order. Rows of a tick come before its sample, or with it. Session's thread; a sink
/// throws RunError if the session cannot go on without it.
class Sink {
 public:
  virtual ~Sink() = default;
  /// @param row  of /trials that the pass will have
  virtual void begin_pass(const PassRow& pass, std::int32_t row) {
    static_cast<void>(pass);
    static_cast<void>(row);
  }
  /// Takes rows of a table of the protocol, of answers or of devices after the first.
  virtual void rows(const Rows& rows) { static_cast<void>(rows); }
  virtual void samples(std::span<const Sample> samples) { static_cast<void>(samples); }
  virtual void end_pass(const PassRow& pass) { static_cast<void>(pass); }
  virtual void event(const EventRow& event) { static_cast<void>(event); }
};

}  // namespace haptrial::record
