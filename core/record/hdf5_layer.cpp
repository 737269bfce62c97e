#include "core/record/hdf5_layer.h"

#include <hdf5.h>

#include <array>
#include <fstream>
#include <utility>

namespace haptrial::record::h5 {
namespace {

static_assert(sizeof(hid_t) == sizeof(std::int64_t));

constexpr unsigned kDeflateLevel = 1;  // as noted in the file; readers do not need it

std::recursive_mutex& process_mutex() {
  static std::recursive_mutex mutex;
  return mutex;
}

/// The innermost entry of HDF5's error stack; of a system error, only its own words.
std::string reason() {
  std::string text;
  H5Ewalk2(
      H5E_DEFAULT, H5E_WALK_UPWARD,
      [](unsigned depth, const H5E_error2_t* entry, void* out) -> herr_t {
        if (depth == 0 && entry->desc != nullptr) {
          *static_cast<std::string*>(out) = entry->desc;
        }
        return 0;
      },
      &text);
  constexpr std::string_view kMark = "error message = '";
  if (const std::size_t at = text.find(kMark); at != std::string::npos) {
    const std::size_t from = at + kMark.size();
    text = text.substr(from, text.find('\'', from) - from);
  }
  H5Eclear2(H5E_DEFAULT);
  return text.empty() ? "HDF5 gave no reason" : text;
}

[[noreturn]] void fail(const std::string& what) { throw Error(what + ": " + reason()); }

Id take(hid_t id, const std::string& what) {
  if (id < 0) fail(what);
  return Id(id);
}

void check(herr_t status, const std::string& what) {
  if (status < 0) fail(what);
}

Id access_list() {
  Id list = take(H5Pcreate(H5P_FILE_ACCESS), "file access list");
  check(H5Pset_libver_bounds(list.get(), H5F_LIBVER_V110, H5F_LIBVER_V110), "library version");
  // A file system without locks must not keep a session from being recorded.
  check(H5Pset_file_locking(list.get(), true, true), "file locking");
  return list;
}

/// Whether the superblock (version 3) carries the marks of a SWMR writer: the bits 0 and 2 of
/// byte 11.
bool marked_as_written(const std::filesystem::path& path) {
  std::array<char, 12> head{};
  std::ifstream in(path, std::ios::binary);
  return in.read(head.data(), head.size()) && head[8] == 3 && (head[11] & 5) == 5;
}

Id text_type(std::size_t bytes) {
  Id type = take(H5Tcopy(H5T_C_S1), "text type");
  check(H5Tset_size(type.get(), bytes), "text type");
  check(H5Tset_cset(type.get(), H5T_CSET_UTF8), "text type");
  check(H5Tset_strpad(type.get(), H5T_STR_NULLPAD), "text type");
  return type;
}

Id long_text_type() {
  Id type = take(H5Tcopy(H5T_C_S1), "text type");
  check(H5Tset_size(type.get(), H5T_VARIABLE), "text type");
  check(H5Tset_cset(type.get(), H5T_CSET_UTF8), "text type");
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

/// Creates the attribute, or writes an existing one again.
void put_raw(const Id& object, const char* name, hid_t type, const void* data, std::size_t count,
             bool scalar) {
  const std::string what = std::string("attribute ") + name;
  const htri_t exists = H5Aexists(object.get(), name);
  if (exists < 0) fail(what);
  Id attribute;
  if (exists > 0) {
    attribute = take(H5Aopen(object.get(), name, H5P_DEFAULT), what);
  } else {
    const hsize_t size = count;
    const Id space =
        take(scalar ? H5Screate(H5S_SCALAR) : H5Screate_simple(1, &size, nullptr), what);
    attribute =
        take(H5Acreate2(object.get(), name, type, space.get(), H5P_DEFAULT, H5P_DEFAULT), what);
  }
  check(H5Awrite(attribute.get(), type, data), what);
}

template <typename T>
T get_number(const Id& object, const char* name, hid_t type, H5T_class_t type_class) {
  const Lock lock;
  const std::string what = std::string("attribute ") + name;
  const Id attribute = take(H5Aopen(object.get(), name, H5P_DEFAULT), what);
  const Id stored = take(H5Aget_type(attribute.get()), what);
  const Id space = take(H5Aget_space(attribute.get()), what);
  if (H5Tget_class(stored.get()) != type_class || H5Sget_simple_extent_npoints(space.get()) != 1) {
    throw Error(what + " is not one number of the kind expected");
  }
  T value{};
  check(H5Aread(attribute.get(), type, &value), what);
  return value;
}

}  // namespace

Lock::Lock() : hold_(process_mutex()) {
  // Nothing is left to HDF5's exit handler, which crashes on a file that it could not close.
  [[maybe_unused]] static const herr_t no_exit_handler = H5dont_atexit();
  H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
}

Id& Id::operator=(Id&& other) noexcept {
  if (this != &other) {
    reset();
    id_ = std::exchange(other.id_, -1);
  }
  return *this;
}

bool Id::reset() noexcept {
  const std::int64_t id = std::exchange(id_, -1);
  if (id < 0) return true;
  const Lock lock;
  const H5I_type_t type = H5Iget_type(id);
  if (type == H5I_FILE) return H5Fclose(id) >= 0;
  if (type == H5I_DATASET) return H5Dclose(id) >= 0;
  return H5Idec_ref(id) >= 0;
}

Id create_file(const std::filesystem::path& path) {
  const Lock lock;
  const Id access = access_list();
  return take(H5Fcreate(path.c_str(), H5F_ACC_EXCL, H5P_DEFAULT, access.get()), "cannot create");
}

Id open_file(const std::filesystem::path& path) {
  const Lock lock;
  const Id access = access_list();
  Id file(H5Fopen(path.c_str(), H5F_ACC_RDONLY, access.get()));
  if (file) return file;
  const std::string first = reason();
  // A file whose writer was killed or is still at work opens only as a SWMR reader, which reads
  // what looks torn again after 1, 2, 4, ... ns: 24 times make 17 ms, HDF5's own 100 for ever.
  check(H5Pset_metadata_read_attempts(access.get(), 24), "read attempts");
  if (marked_as_written(path)) {
    file = Id(H5Fopen(path.c_str(), H5F_ACC_RDONLY | H5F_ACC_SWMR_READ, access.get()));
  }
  if (!file) throw Error(first);
  return file;
}

void start_swmr(const Id& file) {
  const Lock lock;
  check(H5Fstart_swmr_write(file.get()), "cannot start ordered writing");
}

void flush(const Id& file) {
  const Lock lock;
  check(H5Fflush(file.get(), H5F_SCOPE_GLOBAL), "cannot flush");
}

void close(Id& file) {
  const Lock lock;
  if (!file.reset()) fail("cannot close");
}

int descriptor(const Id& file) {
  const Lock lock;
  void* handle = nullptr;
  check(H5Fget_vfd_handle(file.get(), H5P_DEFAULT, &handle), "no file descriptor");
  return *static_cast<int*>(handle);
}

void put(const Id& object, const char* attribute, const std::string& value) {
  const Lock lock;
  const Id type = long_text_type();
  const char* text = value.c_str();
  put_raw(object, attribute, type.get(), &text, 1, true);
}

void put(const Id& object, const char* attribute, const std::vector<std::string>& values) {
  const Lock lock;
  const Id type = long_text_type();
  std::vector<const char*> texts;
  for (const std::string& value : values) texts.push_back(value.c_str());
  put_raw(object, attribute, type.get(), texts.data(), texts.size(), false);
}

void put(const Id& object, const char* attribute, const std::vector<double>& values) {
  const Lock lock;
  put_raw(object, attribute, H5T_IEEE_F64LE, values.data(), values.size(), false);
}

void put(const Id& object, const char* attribute, double value) {
  const Lock lock;
  put_raw(object, attribute, H5T_IEEE_F64LE, &value, 1, true);
}

void put(const Id& object, const char* attribute, std::int64_t value) {
  const Lock lock;
  put_raw(object, attribute, H5T_STD_I64LE, &value, 1, true);
}

void put(const Id& object, const char* attribute, std::uint64_t value) {
  const Lock lock;
  put_raw(object, attribute, H5T_STD_U64LE, &value, 1, true);
}

std::string get_text(const Id& object, const char* attribute) {
  const Lock lock;
  const std::string what = std::string("attribute ") + attribute;
  const Id id = take(H5Aopen(object.get(), attribute, H5P_DEFAULT), what);
  const Id stored = take(H5Aget_type(id.get()), what);
  if (H5Tget_class(stored.get()) != H5T_STRING || H5Tis_variable_str(stored.get()) <= 0) {
    throw Error(what + " is not a text");
  }
  const Id type = long_text_type();
  char* text = nullptr;
  check(H5Aread(id.get(), type.get(), static_cast<void*>(&text)), what);
  std::string value = text == nullptr ? "" : text;
  H5free_memory(text);
  return value;
}

double get_f64(const Id& object, const char* attribute) {
  return get_number<double>(object, attribute, H5T_NATIVE_DOUBLE, H5T_FLOAT);
}

std::int64_t get_i64(const Id& object, const char* attribute) {
  return get_number<std::int64_t>(object, attribute, H5T_NATIVE_INT64, H5T_INTEGER);
}

std::uint64_t get_u64(const Id& object, const char* attribute) {
  return get_number<std::uint64_t>(object, attribute, H5T_NATIVE_UINT64, H5T_INTEGER);
}

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

Id open_table(const Id& file, const TableSchema& schema, std::size_t& chunk_rows) {
  const Lock lock;
  const std::string what = std::string("/") + schema.name;
  if (H5Lexists(file.get(), schema.name, H5P_DEFAULT) <= 0) throw Error(what + " is missing");
  Id table = take(H5Dopen2(file.get(), schema.name, H5P_DEFAULT), what);
  const Id type = take(H5Dget_type(table.get()), what);
  const Id expected = row_type(schema);
  if (H5Tequal(type.get(), expected.get()) <= 0) throw Error(what + " has other columns");
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
  chunk_rows = chunk;
  return table;
}

std::uint64_t row_count(const Id& table) {
  const Lock lock;
  const Id space = take(H5Dget_space(table.get()), "row count");
  const hssize_t rows = H5Sget_simple_extent_npoints(space.get());
  if (rows < 0) fail("row count");
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
  if (size == 0) throw Error("a chunk is missing");
  std::vector<std::uint8_t> bytes(size);
  std::uint32_t skipped = 0;
  check(H5Dread_chunk(table.get(), H5P_DEFAULT, &offset, &skipped, bytes.data()), "cannot read");
  if (skipped != 0) throw Error("a chunk lacks a filter");
  return bytes;
}

}  // namespace haptrial::record::h5
