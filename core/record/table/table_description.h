#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "core/record/table/byte_planes.h"
#include "core/record/table/field.h"
#include "core/record/table/schema.h"

namespace haptrial::record {

/// Owner of the rows of a table; writer, check and recovery keep them together with it.
enum class RowsOf : std::uint8_t {
  kSession,    // nothing else: a row stands for itself
  kEachTick,   // exactly one row for each row of /samples; the column `sequence` numbers it
  kTick,       // the tick that the column `sequence` numbers, in ascending order
  kEndedPass,  // the row of /trials that the column `pass` numbers: written when it is there
  kPass,       // the same, but written while the pass may still be under way
};

struct TableHead {
  const char* name;
  const char* description;
  std::size_t chunk_rows;
  RowsOf of{RowsOf::kSession};
  std::vector<const char*> order{};  // columns of integers that bring recovered rows in order
  const char* group{""};  // recovery makes all tables of a group anew when it finds rows of one
  std::int64_t since{1};  // schema version from which on files may have the table
  bool dense{false};      // large and noisy: compressed more closely, which takes longer
};

/// One table of the session file: its rows as C++ has them and as the file does, each column
/// described once. Everything that handles rows follows from it: schema, writer, reader, recovery,
/// check, and the tables of docs/session-file.md. Make one with Table<Row>.
///
/// Rows are passed by the address of the first, contiguous, as in a std::vector<Row>. const members
/// may be called from several threads at once.
class TableDescription {
 public:
  virtual ~TableDescription() = default;

  const std::string& name() const { return name_; }
  RowsOf of() const { return head_.of; }
  const char* group() const { return head_.group; }
  std::int64_t since() const { return head_.since; }
  bool dense() const { return head_.dense; }
  const std::vector<Field>& fields() const { return fields_; }
  std::size_t row_size() const { return row_size_; }  // in memory [bytes]

  /// The layout in files of a schema version.
  const TableSchema& schema(std::int64_t version = kSchemaVersion) const;
  /// Every layout that a file may have, the present one first.
  std::vector<std::int64_t> versions() const;

  /// Writes rows to the rows [at, at + count) of the planes.
  /// @throws std::invalid_argument for a text that does not fit its column or holds a NUL byte, or
  /// an enumerator without a word; then nothing was written.
  void put(BytePlanes& planes, std::size_t at, const void* rows, std::size_t count) const;
  /// Reads the rows [at, at + count) of a chunk; columns that the version lacks stay as they are.
  /// @throws UnknownWord
  void get(const BytePlanes& planes, std::size_t at, void* rows, std::size_t count,
           std::int64_t version = kSchemaVersion) const;

  /// Rows [0, count) of a chunk in the present layout, one packed row after the other.
  /// @throws UnknownWord
  std::vector<std::uint8_t> packed(const BytePlanes& planes, std::size_t count,
                                   std::int64_t version = kSchemaVersion) const;
  /// The rows of such bytes.
  void unpack(const std::vector<std::uint8_t>& packed, void* rows) const;
  /// Whether all columns with words hold words of theirs.
  bool fits(const BytePlanes& planes, std::size_t count, std::int64_t version) const;
  /// Key of a packed row: the columns of TableHead::order, and one column of integers.
  std::vector<std::int64_t> key(const std::uint8_t* row) const;
  std::int64_t integer(const std::uint8_t* row, const char* column,
                       std::int64_t version = kSchemaVersion) const;

 protected:
  using Convert = void (*)(const TableDescription&, const BytePlanes&, std::size_t, std::int64_t,
                           BytePlanes&);
  /// @throws std::invalid_argument for a column that is named twice, or one that is missing
  TableDescription(TableHead head, std::vector<std::vector<Field>> fields, std::size_t row_size,
                   Convert convert);

  std::function<void(void* row, std::int64_t version)> complete_;  // after reading

 private:
  struct Layout {
    std::int64_t since;
    std::vector<std::size_t> fields;  // of fields_, in order
    std::vector<Column> columns;
    TableSchema schema;
  };
  const Layout& layout(std::int64_t version) const;
  void check(const Field& field, const std::uint8_t* rows, std::size_t count) const;

  TableHead head_;
  std::string name_;
  std::vector<Field> fields_;
  std::size_t row_size_;
  Convert convert_;
  std::vector<std::shared_ptr<const Layout>> layouts_;  // in descending order of `since`
};

/// The tables that a protocol records beside those of every session.
using TableList = std::vector<const TableDescription*>;

}  // namespace haptrial::record
