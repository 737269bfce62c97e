#include "core/record/hdf5/table_in_file.h"

#include "core/record/hdf5/hdf5_internal.h"
#include "core/record/hdf5/hdf5_layer.h"

namespace haptrial::record::h5 {
namespace {

ColumnType number_kind(const Id& type, const std::string& what) {
  const std::size_t bytes = H5Tget_size(type.get());
  if (H5Tget_class(type.get()) == H5T_FLOAT && bytes == sizeof(float)) {
    return ColumnType::kF32;
  }
  if (H5Tget_class(type.get()) == H5T_FLOAT && bytes == sizeof(double)) {
    return ColumnType::kF64;
  }
  const bool is_signed = H5Tget_sign(type.get()) == H5T_SGN_2;
  if (H5Tget_class(type.get()) == H5T_INTEGER) {
    if (bytes == 1 && !is_signed) {
      return ColumnType::kU8;
    }
    if (bytes == sizeof(std::int32_t) && is_signed) {
      return ColumnType::kI32;
    }
    if (bytes == sizeof(std::int64_t)) {
      return is_signed ? ColumnType::kI64 : ColumnType::kU64;
    }
  }
  throw Error(what + " is of a kind that no table has");
}

ColumnInFile column_of(const Id& row, unsigned i, const std::string& table) {
  ColumnInFile column;
  char* name = H5Tget_member_name(row.get(), i);
  column.name = name == nullptr ? "" : name;
  H5free_memory(name);
  const std::string what = table + "." + column.name;
  const Id type = take(H5Tget_member_type(row.get(), i), what);
  column.bytes = H5Tget_size(type.get());
  column.type =
      H5Tget_class(type.get()) == H5T_STRING ? ColumnType::kText : number_kind(type, what);
  return column;
}

}  // namespace

TableInFile table_in_file(const Id& file, const std::string& name) {
  const Lock lock;
  if (!has_table(file, name.c_str())) {
    throw Error("/" + name + " is missing");
  }
  TableInFile found;
  found.name = name;
  std::size_t row_bytes = 0;
  const Id table = open_table(file, name, row_bytes, found.chunk_rows);
  found.description = get_text(table, "description");
  const std::vector<std::string> units = get_texts(table, "units");
  const std::vector<std::string> descriptions = get_texts(table, "column_descriptions");
  const std::vector<double> resolutions = get_numbers(table, "resolution");
  const Id row = take(H5Dget_type(table.get()), "/" + name);
  const auto count = static_cast<std::size_t>(H5Tget_nmembers(row.get()));
  if (units.size() != count || descriptions.size() != count || resolutions.size() != count) {
    throw Error("/" + name + " does not describe each of its columns");
  }
  for (std::size_t i = 0; i < count; ++i) {
    ColumnInFile column = column_of(row, static_cast<unsigned>(i), "/" + name);
    column.unit = units[i];
    column.description = descriptions[i];
    column.resolution = resolutions[i];
    found.columns.push_back(std::move(column));
  }
  return found;
}

}  // namespace haptrial::record::h5
