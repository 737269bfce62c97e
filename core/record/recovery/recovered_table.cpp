#include "core/record/recovery/recovered_table.h"

#include <algorithm>
#include <cstring>
#include <tuple>
#include <utility>

#include "core/record/hdf5/deflate.h"

namespace haptrial::record {
namespace {

BytePlanes planes_of(std::span<const std::uint8_t> raw, std::size_t row_bytes) {
  BytePlanes planes(row_bytes, raw.size() / row_bytes);
  std::memcpy(planes.data(), raw.data(), raw.size());
  return planes;
}

bool is_chunk_of(const TableSchema& schema, std::size_t bytes, bool each_tick) {
  if (each_tick) {
    return bytes % (kLiveChunkStep * schema.row_bytes()) == 0 &&
           bytes <= schema.chunk_rows * schema.row_bytes();
  }
  return bytes == schema.chunk_rows * schema.row_bytes();
}

}  // namespace

bool RecoveredTable::take_if_ours(std::uint64_t offset, std::span<const std::uint8_t> raw) {
  for (const std::int64_t version : table_->versions()) {
    const TableSchema& schema = table_->schema(version);
    if (!is_chunk_of(schema, raw.size(), each_tick())) {
      continue;
    }
    const BytePlanes planes = planes_of(raw, schema.row_bytes());
    const bool older = version != table_->versions().front();
    const bool own_size = !older && !each_tick();  // so that even zeros are a row of this table
    const std::size_t rows = std::max<std::size_t>(own_size ? 1 : 0, planes.rows_in_use());
    if (older && !table_->fits(planes, rows, version)) {
      continue;  // another table's: sizes of older layouts are not unique
    }
    if (rows == 0) {
      return true;
    }
    std::vector<std::uint8_t> packed = table_->packed(planes, rows, version);
    const std::size_t bytes = table_->schema().row_bytes();
    if (each_tick() && !are_ticks(packed)) {
      continue;
    }
    const std::string first_row(reinterpret_cast<const char*>(packed.data()), bytes);
    Piece& piece = by_first_row_[first_row];
    if (rows < piece.rows) {
      return true;
    }
    piece = {offset,
             raw.size(),
             rows,
             version,
             table_->key(packed.data()),
             table_->key(packed.data() + (rows - 1) * bytes)};
    if (!each_tick()) {
      piece.packed = std::move(packed);
    }
    return true;
  }
  return false;
}

/// Whether the rows are those of ticks, of which nearly all follow each other; else they are rows
/// of another table whose chunks may be as long.
bool RecoveredTable::are_ticks(const std::vector<std::uint8_t>& packed) const {
  constexpr std::int64_t kMost = std::int64_t{1} << 40;  // 30 years at 1 kHz
  const std::size_t bytes = table_->schema().row_bytes();
  std::int64_t last = -1;
  std::size_t jumps = 0;
  for (std::size_t at = 0; at < packed.size(); at += bytes) {
    const std::int64_t tick = table_->integer(packed.data() + at, "sequence");
    if (tick <= last || tick > kMost) {
      return false;
    }
    jumps += at > 0 && tick != last + 1 ? 1 : 0;
    last = tick;
  }
  return 4 * jumps <= packed.size() / bytes + 2;  // a short chunk may have one
}

void RecoveredTable::finish() {
  for (auto& [first_row, piece] : by_first_row_) {
    count_ += piece.rows;
    pieces_.push_back(std::move(piece));
  }
  by_first_row_.clear();
  std::stable_sort(pieces_.begin(), pieces_.end(), [](const Piece& a, const Piece& b) {
    return std::tie(a.first, a.last) < std::tie(b.first, b.last);
  });
  if (!each_tick()) {
    join();
  }
}

/// All rows become one piece: chunk after chunk, as the rows were written.
void RecoveredTable::join() {
  Piece whole;
  for (const Piece& piece : pieces_) {
    whole.rows += piece.rows;
    whole.packed.insert(whole.packed.end(), piece.packed.begin(), piece.packed.end());
  }
  if (!pieces_.empty()) {
    pieces_.assign(1, std::move(whole));
  }
}

std::vector<std::uint8_t> RecoveredTable::piece(std::size_t number) const {
  const Piece& piece = pieces_.at(number);
  if (!each_tick()) {
    return piece.packed;
  }
  std::vector<std::uint8_t> raw(piece.raw);
  Inflater inflater;
  raw.resize(inflater.decompress_prefix(file_.subspan(piece.offset), raw).raw);
  const BytePlanes planes = planes_of(raw, table_->schema(piece.version).row_bytes());
  const std::vector<std::uint8_t> rows = table_->packed(planes, piece.rows, piece.version);
  // A piece never reaches into the next, and zeros before the last row would be rows of no tick.
  const std::size_t bytes = table_->schema().row_bytes();
  const bool is_last = number + 1 == pieces_.size();
  std::vector<std::uint8_t> kept;
  std::int64_t last = piece.first.front();
  for (std::size_t at = 0; at < rows.size(); at += bytes) {
    const std::int64_t sequence = table_->integer(rows.data() + at, "sequence");
    if (sequence < last || (!is_last && sequence >= pieces_[number + 1].first.front())) {
      continue;
    }
    last = sequence;
    const auto from = rows.begin() + static_cast<std::ptrdiff_t>(at);
    kept.insert(kept.end(), from, from + static_cast<std::ptrdiff_t>(bytes));
  }
  return kept;
}

}  // namespace haptrial::record
