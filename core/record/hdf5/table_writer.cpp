#include "core/record/hdf5/table_writer.h"

#include <algorithm>
#include <utility>

namespace haptrial::record {

TableWriter::TableWriter(const h5::Id& file, const TableSchema& schema, int level,
                         EnsureSpace ensure_space)
    : TableWriter(h5::create_table(file, schema), schema, schema.chunk_rows, level,
                  std::move(ensure_space)) {}

TableWriter::TableWriter(h5::Id dataset, const TableSchema& schema, std::size_t chunk_rows,
                         int level, EnsureSpace ensure_space)
    : dataset_(std::move(dataset)),
      ensure_space_(std::move(ensure_space)),
      planes_(schema.row_bytes(), chunk_rows),
      deflater_(level) {}

TableWriter TableWriter::go_on(const h5::Id& file, const TableSchema& schema, int level,
                               EnsureSpace ensure_space) {
  std::size_t chunk_rows = 0;
  h5::Id dataset = h5::open_table(file, schema, chunk_rows);
  const std::uint64_t rows = h5::row_count(dataset);
  TableWriter table(std::move(dataset), schema, chunk_rows, level, std::move(ensure_space));
  table.used_ = rows % chunk_rows;
  table.first_row_ = rows - table.used_;
  if (table.used_ > 0) {
    const std::vector<std::uint8_t> bytes = h5::read_chunk(table.dataset_, table.first_row_);
    Inflater inflater;
    if (!inflater.decompress(bytes, {table.planes_.data(), table.planes_.bytes().size()})) {
      throw h5::Error(std::string("the last chunk of /") + schema.name + " does not inflate");
    }
    table.written_ = table.used_;
    table.written_bytes_ = bytes.size();
  }
  return table;
}

void TableWriter::added(std::size_t rows) {
  used_ += rows;
  if (room() > 0) {
    return;
  }
  write();
  first_row_ += used_;
  used_ = 0;
  written_ = 0;
  written_bytes_ = 0;
}

void TableWriter::add(const TableDescription& table, const void* rows, std::size_t count) {
  const auto* from = static_cast<const std::uint8_t*>(rows);
  for (std::size_t done = 0; done < count;) {
    const std::size_t part = std::min(room(), count - done);
    table.put(planes_, used_, from + done * table.row_size(), part);
    added(part);
    done += part;
  }
}

void TableWriter::write_unfinished() {
  if (used_ == written_) {
    return;
  }
  planes_.clear_from(used_);
  write();
}

void TableWriter::write() {
  std::span<const std::uint8_t> bytes = deflater_.compress(planes_.bytes());
  // HDF5 writes a chunk that kept its size over itself, and a kill in between would tear rows that
  // were safe before; another size gets another place. Inflating stops before the extra byte.
  if (bytes.size() == written_bytes_) {
    bytes = deflater_.padded();
  }
  ensure_space_(bytes.size());
  const h5::Lock lock;
  h5::set_row_count(dataset_, first_row_ + used_);
  h5::write_chunk(dataset_, first_row_, bytes);
  written_ = used_;
  written_bytes_ = bytes.size();
}

}  // namespace haptrial::record
