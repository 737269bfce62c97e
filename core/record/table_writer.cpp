#include "core/record/table_writer.h"

#include <utility>

namespace haptrial::record {
namespace {

constexpr int kLevel = 1;

}  // namespace

TableWriter::TableWriter(const h5::Id& file, const TableSchema& schema, EnsureSpace ensure_space)
    : dataset_(h5::create_table(file, schema)),
      ensure_space_(std::move(ensure_space)),
      planes_(schema.row_bytes(), schema.chunk_rows),
      deflater_(kLevel) {}

void TableWriter::added(std::size_t rows) {
  used_ += rows;
  if (room() > 0) return;
  write();
  first_row_ += used_;
  used_ = 0;
  written_ = 0;
}

void TableWriter::write_unfinished() {
  if (used_ == written_) return;
  planes_.clear_from(used_);
  write();
}

void TableWriter::write() {
  const std::span<const std::uint8_t> bytes = deflater_.compress(planes_.bytes());
  ensure_space_(bytes.size());
  const h5::Lock lock;
  h5::set_row_count(dataset_, first_row_ + used_);
  h5::write_chunk(dataset_, first_row_, bytes);
  written_ = used_;
}

}  // namespace haptrial::record
