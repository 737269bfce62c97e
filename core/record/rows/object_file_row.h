#pragma once

#include <cstdint>
#include <string>

#include "core/record/table/table.h"

namespace haptrial::record {

/// The mesh file of an object as it was when the session began, a row of /object_files.
struct ObjectFileRow {
  std::int32_t object{0};     // of [objects] in the order of names, from 0
  std::string name;           // of the object
  std::string file;           // as the definition names it
  std::uint64_t bytes{0};     // its size
  std::uint64_t checksum{0};  // FNV-1a of its bytes
};

template <>
const Table<ObjectFileRow>& table_of<ObjectFileRow>();

}  // namespace haptrial::record
