#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/record/read/table_columns.h"
#include "core/record/rows/answer_rows.h"
#include "core/record/rows/session_types.h"
#include "core/record/table/cells.h"
#include "core/record/table/table.h"

namespace haptrial::record {

/// The columns of /samples that analysis reads in bulk.
struct SampleColumns {
  std::vector<std::int64_t> time_ns;  // (rows)      [ns]
  Eigen::Matrix3Xd position;          // (3 x rows)  p_W [m]
  Eigen::VectorXd applied_force;      // (rows)      [N]
  Eigen::VectorXd target_force;       // (rows)      [N]
};

/// How a table of a file stands.
struct TableState {
  std::string name;
  std::uint64_t rows{0};
  std::string fault;  // why some of them cannot be had, in words; empty where all can
};

/// Reads a session file (docs/session-file.md), also the .partial of a session that was killed or
/// still runs in another process; such a file is seen as it stood when it was opened.
///
/// Every member throws InputError, in one sentence that names the file, where its contents are
/// damaged. const members may be called from several threads at once.
class SessionReader {
 public:
  /// @throws InputError when the file is absent, a directory, not HDF5, cut short, or not a session
  /// file of a schema version up to this one.
  explicit SessionReader(const std::filesystem::path& path);
  ~SessionReader();
  SessionReader(SessionReader&&) noexcept;
  SessionReader& operator=(SessionReader&&) noexcept;

  const std::filesystem::path& path() const;
  const SessionInfo& info() const;
  std::int64_t version() const;  // of the file's schema
  std::uint64_t sample_count() const;
  std::size_t chunk_rows() const;  // length of a chunk of /samples

  /// Rows [first, first + count) of /samples. Those of given ticks: tick_rows.h
  /// @throws std::invalid_argument when they are not all there.
  std::vector<Sample> samples(std::uint64_t first, std::uint64_t count) const;
  SampleColumns columns(std::uint64_t first, std::uint64_t count) const;

  /// Passes whose answers the experimenter took back (/taken_back) are aborted ones.
  std::vector<PassRow> passes() const;
  std::vector<EventRow> events() const;
  std::vector<FrameRow> frames() const;  // none in a file of schema version 1
  std::vector<StimulusRow> stimuli() const;
  /// Whether the file has a table; of one that a protocol recorded it has all.
  bool has(const TableDescription& table) const;
  /// Rows of a table of a protocol, all or [first, first + count); none in a file without it.
  /// @throws std::invalid_argument when they are not all there.
  std::uint64_t count(const TableDescription& table) const;
  template <class Row>
  std::vector<Row> rows(const Table<Row>& table, std::uint64_t first, std::uint64_t count) const {
    std::vector<Row> result(static_cast<std::size_t>(std::min(count, this->count(table))));
    read(table, first, count, result.data());
    return result;
  }
  template <class Row>
  std::vector<Row> rows(const Table<Row>& table) const {
    return rows(table, 0, count(table));
  }
  template <class Row>
  std::uint64_t count() const {
    return count(table_of<Row>());
  }
  template <class Row>
  std::vector<Row> rows() const {
    return rows(table_of<Row>());
  }
  template <class Row>
  std::vector<Row> rows(std::uint64_t first, std::uint64_t count) const {
    return rows(table_of<Row>(), first, count);
  }
  /// One column of integers of a table that the file has.
  std::vector<std::int64_t> integers(const TableDescription& table, const char* column,
                                     std::uint64_t first, std::uint64_t count) const;
  /// Every row of a table that the file has, value by value, in the present layout.
  void each_row(const TableDescription& table,
                const std::function<void(const std::vector<Cell>&)>& take) const;
  std::vector<ResponseRow> responses() const { return rows<ResponseRow>(); }
  /// Columns of rows [first, first + count) of a table that the file has, in the present layout:
  /// numbers little-endian, texts padded with zeros. @throws std::invalid_argument as rows()
  void columns(const TableDescription& table, std::uint64_t first, std::uint64_t count,
               std::span<const ColumnTarget> targets) const;

  std::vector<std::string> table_names() const;  // that the file has
  /// The file's own description of a table, for tables that this program does not know.
  std::unique_ptr<const TableDescription> description(const std::string& table) const;

  std::vector<TimingRow> timing() const;  // of all runs together, in ascending order
  /// Counts of the loop, as they were written; none in a file before schema version 4.
  std::vector<RunRow> runs() const;
  std::vector<BegunRow> begun() const;  // likewise
  /// Reads every chunk of every table: one that cannot be inflated, or has fewer rows than the
  /// table says, is a fault of its table.
  std::vector<TableState> tables() const;
  /// Nothing when the session did not come to its end.
  std::optional<TimingSummary> timing_summary() const;

 private:
  void read(const TableDescription& table, std::uint64_t first, std::uint64_t count,
            void* rows) const;
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace haptrial::record
