#include "core/record/hdf5/hdf5_layer.h"

#include <array>

#include "core/record/hdf5/hdf5_internal.h"

namespace haptrial::record::h5 {
namespace {

constexpr unsigned kDeflateLevel = 1;  // as noted in the file; readers do not need it

Id text_type(std::size_t bytes) {
  Id type = take(H5Tcopy(H5T_C_S1), "text type");
  check(H5Tset_size(type.get(), bytes), "text type");
  check(H5Tset_cset(type.get(), H5T_CSET_UTF8), "text type");
  check(H5Tset_strpad(type.get(), H5T_STR_NULLPAD), "text type");
  return type;
}

hid_t number_type(ColumnType type) {
  switch (type) {
    case ColumnType::kU8:
      return H5T_STD_U8LE;
    case ColumnType::kI32:
      return H5T_STD_I32LE;
    case ColumnType::kI64:
      return H5T_STD_I64LE;
    case ColumnType::kU64:
      return H5T_STD_U64LE;
    case ColumnType::kF32:
      return H5T_IEEE_F32LE;
    case ColumnType::kF64:
      return H5T_IEEE_F64LE;
    case ColumnType::kText:
      break;
  }
  return -1;
}

Id row_type(const TableSchema& schema) {
  Id type = take(H5Tcreate(H5T_COMPOUND, schema.row_bytes()), "row type");
  std::size_t offset = 0;
  for (const Column& column : schema.columns) {
    if (column.type == ColumnType::kText) {
      const Id text = text_type(column.bytes);
      check(H5Tinsert(type.get(), column.name, offset, text.get()), "row type");
    } else {
      check(H5Tinsert(type.get(), column.name, offset, number_type(column.type)), "row type");
    }
    offset += column.bytes;
  }
  return type;
}

}  // namespace

Id create_table(const Id& file, const TableSchema& schema) {
  const Lock lock;
  const std::string what = std::string("/") + schema.name;
  const hsize_t none = 0;
  const hsize_t unlimited = H5S_UNLIMITED;
  const hsize_t chunk = schema.chunk_rows;
  const Id space = take(H5Screate_simple(1, &none, &unlimited), what);
  const Id list = take(H5Pcreate(H5P_DATASET_CREATE), what);
  check(H5Pset_chunk(list.get(), 1, &chunk), what);
  check(H5Pset_shuffle(list.get()), what);
  check(H5Pset_deflate(list.get(), kDeflateLevel), what);
  const Id type = row_type(schema);
  Id table = take(H5Dcreate2(file.get(), schema.name, type.get(), space.get(), H5P_DEFAULT,
                             list.get(), H5P_DEFAULT),
                  what);
  std::vector<std::string> names, units, descriptions;
  std::vector<double> resolutions;
  for (const Column& column : schema.columns) {
    names.emplace_back(column.name);
    units.emplace_back(column.unit);
    descriptions.emplace_back(column.description);
    resolutions.push_back(column.resolution);
  }
  put(table, "description", std::string(schema.description));
  put(table, "columns", names);
  put(table, "units", units);
  put(table, "resolution", resolutions);
  put(table, "column_descriptions", descriptions);
  return table;
}

namespace {

/// @throws Error unless it is stored as tables are; @returns rows of a chunk
std::size_t chunk_of(const Id& table, const std::string& what) {
  const Id list = take(H5Dget_create_plist(table.get()), what);
  std::array<H5Z_filter_t, 2> filters{};
  const int count = H5Pget_nfilters(list.get());
  for (unsigned i = 0; count == 2 && i < 2; ++i) {
    unsigned flags = 0;
    std::size_t values = 0;
    filters[i] = H5Pget_filter2(list.get(), i, &flags, &values, nullptr, 0, nullptr, nullptr);
  }
  hsize_t chunk = 0;
  if (filters != std::array{H5Z_FILTER_SHUFFLE, H5Z_FILTER_DEFLATE} ||
      H5Pget_chunk(list.get(), 1, &chunk) != 1) {
    throw Error(what + " is not stored in chunks with the filters shuffle and deflate");
  }
  return chunk;
}

}  // namespace

Id open_table(const Id& file, const TableSchema& schema, std::size_t& chunk_rows) {
  const Lock lock;
  const std::string what = std::string("/") + schema.name;
  if (H5Lexists(file.get(), schema.name, H5P_DEFAULT) <= 0) {
    throw Error(what + " is missing");
  }
  Id table = take(H5Dopen2(file.get(), schema.name, H5P_DEFAULT), what);
  const Id type = take(H5Dget_type(table.get()), what);
  const Id expected = row_type(schema);
  if (H5Tequal(type.get(), expected.get()) <= 0) {
    throw Error(what + " has other columns");
  }
  chunk_rows = chunk_of(table, what);
  return table;
}

Id open_table(const Id& file, const std::string& name, std::size_t& row_bytes,
              std::size_t& chunk_rows) {
  const Lock lock;
  Id table = take(H5Dopen2(file.get(), name.c_str(), H5P_DEFAULT), "/" + name);
  const Id type = take(H5Dget_type(table.get()), "/" + name);
  row_bytes = H5Tget_size(type.get());
  chunk_rows = chunk_of(table, "/" + name);
  return table;
}

std::vector<std::string> table_names(const Id& file) {
  const Lock lock;
  std::vector<std::string> names;
  const herr_t status = H5Literate(
      file.get(), H5_INDEX_NAME, H5_ITER_INC, nullptr,
      [](hid_t, const char* name, const H5L_info_t*, void* out) -> herr_t {
        static_cast<std::vector<std::string>*>(out)->emplace_back(name);
        return 0;
      },
      &names);
  check(status, "the list of tables");
  return names;
}

bool has_table(const Id& file, const char* name) {
  const Lock lock;
  return H5Lexists(file.get(), name, H5P_DEFAULT) > 0;
}

std::uint64_t row_count(const Id& table) {
  const Lock lock;
  const Id space = take(H5Dget_space(table.get()), "row count");
  const hssize_t rows = H5Sget_simple_extent_npoints(space.get());
  if (rows < 0) {
    fail("row count");
  }
  return static_cast<std::uint64_t>(rows);
}

void set_row_count(const Id& table, std::uint64_t rows) {
  const Lock lock;
  const hsize_t size = rows;
  check(H5Dset_extent(table.get(), &size), "cannot extend");
}

void write_chunk(const Id& table, std::uint64_t row, std::span<const std::uint8_t> bytes) {
  const Lock lock;
  const hsize_t offset = row;
  check(H5Dwrite_chunk(table.get(), H5P_DEFAULT, 0, &offset, bytes.size(), bytes.data()),
        "cannot write");
}

std::vector<std::uint8_t> read_chunk(const Id& table, std::uint64_t row) {
  const Lock lock;
  const hsize_t offset = row;
  hsize_t size = 0;
  check(H5Dget_chunk_storage_size(table.get(), &offset, &size), "cannot read");
  if (size == 0) {
    throw Error("a chunk is missing");
  }
  std::vector<std::uint8_t> bytes(size);
  std::uint32_t skipped = 0;
  check(H5Dread_chunk(table.get(), H5P_DEFAULT, &offset, &skipped, bytes.data()), "cannot read");
  if (skipped != 0) {
    throw Error("a chunk lacks a filter");
  }
  return bytes;
}

}  // namespace haptrial::record::h5
