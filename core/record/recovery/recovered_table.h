#pragma once

#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <vector>

#include "core/record/table/table.h"

namespace haptrial::record {

/// The rows of one table that the chunks of a damaged file hold, in order and once,
/// as packed rows of the present layout, one after the other. Those with a row for each tick stay
/// compressed until they are asked for, piece by piece.
class RecoveredTable {
 public:
  /// @param file  outlives this
  RecoveredTable(const TableDescription& table, std::span<const std::uint8_t> file)
      : table_(&table), file_(file) {}

  /// Takes a chunk of the file that inflated to `raw`; of several copies of a chunk the one with
  /// most rows stays.
  /// @returns false if it is not of this table
  bool take_if_ours(std::uint64_t offset, std::span<const std::uint8_t> raw);
  /// Ends the table; call after the last chunk.
  void finish();

  const TableDescription& table() const { return *table_; }
  std::uint64_t count() const { return count_; }  // rows as stored
  std::size_t pieces() const { return pieces_.size(); }
  /// Rows of a piece: with a row for each tick in ascending order of ticks, from piece to piece as
  /// well; else all rows are one piece.
  std::vector<std::uint8_t> piece(std::size_t number) const;
  /// The same, of the table's own type.
  template <class Row>
  std::vector<Row> rows(const Table<Row>& table, std::size_t number) const {
    const std::vector<std::uint8_t> packed = piece(number);
    std::vector<Row> result(packed.size() / table.schema().row_bytes());
    table.unpack(packed, result.data());
    return result;
  }
  template <class Row>
  std::vector<Row> rows(const Table<Row>& table) const {
    return pieces_.empty() ? std::vector<Row>{} : rows(table, 0);
  }

 private:
  struct Piece {
    std::uint64_t offset{0};  // in the file
    std::size_t raw{0};       // bytes of the chunk when inflated
    std::size_t rows{0};
    std::int64_t version{0};          // of its layout
    std::vector<std::int64_t> first;  // keys of its first and last row
    std::vector<std::int64_t> last;
    std::vector<std::uint8_t> packed{};  // but of a table with a row for each tick
  };
  bool each_tick() const { return table_->of() == RowsOf::kEachTick; }
  bool are_ticks(const std::vector<std::uint8_t>& packed) const;
  void join();

  const TableDescription* table_;
  std::span<const std::uint8_t> file_;
  std::map<std::string, Piece> by_first_row_;  // which a chunk keeps
  std::vector<Piece> pieces_;
  std::uint64_t count_{0};
};

}  // namespace haptrial::record
