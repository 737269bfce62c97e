#pragma once

#include <string>
#include <vector>

#include "core/record/hdf5/hdf5_handle.h"
#include "core/record/table/schema.h"

namespace haptrial::record::h5 {

/// A column as the file itself describes it.
struct ColumnInFile {
  std::string name;
  ColumnType type{ColumnType::kU8};
  std::size_t bytes{0};  // of one value
  std::string unit;
  std::string description;
  double resolution{0.0};
};

/// A table as create_table() described it in the file's attributes.
struct TableInFile {
  std::string name;
  std::string description;
  std::size_t chunk_rows{0};
  std::vector<ColumnInFile> columns;
};

/// @throws Error when it is missing, or has a column of a kind that no table of ours has.
TableInFile table_in_file(const Id& file, const std::string& name);

}  // namespace haptrial::record::h5
