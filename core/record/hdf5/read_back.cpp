#include "core/record/hdf5/read_back.h"

#include <vector>

#include "core/record/hdf5/deflate.h"
#include "core/record/hdf5/hdf5_layer.h"

namespace haptrial::record {
namespace {

/// @throws h5::Error if a chunk is missing or is not what was written.
void inflate_chunks(const h5::Id& table, std::uint64_t rows, std::size_t chunk_rows,
                    std::size_t row_bytes) {
  Inflater inflater;
  std::vector<std::uint8_t> raw(chunk_rows * row_bytes);
  for (std::uint64_t row = 0; row < rows; row += chunk_rows) {
    if (!inflater.decompress(h5::read_chunk(table, row), raw)) {
      throw h5::Error("the rows from " + std::to_string(row) + " on are damaged");
    }
  }
}

void check_table(const h5::Id& file, const WrittenTable& written, bool chunks) {
  std::size_t chunk_rows = 0;
  const h5::Id table = h5::open_table(file, *written.schema, chunk_rows);
  const std::uint64_t rows = h5::row_count(table);
  if (rows != written.rows) {
    throw h5::Error(std::to_string(rows) + " of " + std::to_string(written.rows) + " rows");
  }
  if (chunks) {
    inflate_chunks(table, rows, chunk_rows, written.schema->row_bytes());
  }
}

}  // namespace

std::string find_unreadable(const std::filesystem::path& file, std::span<const WrittenTable> tables,
                            bool chunks) {
  std::string where;  // the table
  try {
    const h5::Id opened = h5::open_file(file);
    for (const WrittenTable& table : tables) {
      where = std::string("/") + table.schema->name;
      check_table(opened, table, chunks);
    }
  } catch (const h5::Error& error) {
    const std::string what = error.what();
    return where.empty() || what.starts_with(where) ? what : where + ": " + what;
  }
  return "";
}

}  // namespace haptrial::record
