#include "core/record/rows/object_file_row.h"

namespace haptrial::record {
namespace {

constexpr std::size_t kObjectNameBytes = 64;
constexpr std::size_t kObjectFileBytes = 256;

}  // namespace

template <>
const Table<ObjectFileRow>& table_of<ObjectFileRow>() {
  using R = ObjectFileRow;
  using T = Table<R>;
  static const T table(
      {"object_files",
       "files of objects as they were when the session began: meshes, and constants of springs",
       4,
       RowsOf::kSession,
       {"object"}},
      {T::column("object", &R::object, "1", "of [objects] in the order of their names, from 0"),
       T::text("name", &R::name, kObjectNameBytes,
               "of the object; with .calibrated behind it for its constants"),
       T::text("file", &R::file, kObjectFileBytes, "as the definition names it"),
       T::column("bytes", &R::bytes, "byte", "size of the file"),
       T::column("checksum", &R::checksum, "1", "64-bit FNV-1a hash of the file's bytes")});
  return table;
}

}  // namespace haptrial::record
