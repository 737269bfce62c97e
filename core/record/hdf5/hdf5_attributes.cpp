#include "core/record/hdf5/hdf5_internal.h"
#include "core/record/hdf5/hdf5_layer.h"

namespace haptrial::record::h5 {
namespace {

Id long_text_type() {
  Id type = take(H5Tcopy(H5T_C_S1), "text type");
  check(H5Tset_size(type.get(), H5T_VARIABLE), "text type");
  check(H5Tset_cset(type.get(), H5T_CSET_UTF8), "text type");
  return type;
}

/// Creates the attribute, or writes an existing one again.
void put_raw(const Id& object, const char* name, hid_t type, const void* data, std::size_t count,
             bool scalar) {
  const std::string what = std::string("attribute ") + name;
  const htri_t exists = H5Aexists(object.get(), name);
  if (exists < 0) {
    fail(what);
  }
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

std::size_t count_of(const Id& attribute, const std::string& what) {
  const Id space = take(H5Aget_space(attribute.get()), what);
  const hssize_t count = H5Sget_simple_extent_npoints(space.get());
  if (count < 0) {
    fail(what);
  }
  return static_cast<std::size_t>(count);
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
  for (const std::string& value : values) {
    texts.push_back(value.c_str());
  }
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

std::vector<std::string> get_texts(const Id& object, const char* attribute) {
  const Lock lock;
  const std::string what = std::string("attribute ") + attribute;
  const Id id = take(H5Aopen(object.get(), attribute, H5P_DEFAULT), what);
  const Id stored = take(H5Aget_type(id.get()), what);
  if (H5Tget_class(stored.get()) != H5T_STRING || H5Tis_variable_str(stored.get()) <= 0) {
    throw Error(what + " is not a list of texts");
  }
  std::vector<char*> texts(count_of(id, what), nullptr);
  const Id type = long_text_type();
  check(H5Aread(id.get(), type.get(), texts.data()), what);
  std::vector<std::string> values;
  for (char* text : texts) {
    values.emplace_back(text == nullptr ? "" : text);
    H5free_memory(text);
  }
  return values;
}

std::vector<double> get_numbers(const Id& object, const char* attribute) {
  const Lock lock;
  const std::string what = std::string("attribute ") + attribute;
  const Id id = take(H5Aopen(object.get(), attribute, H5P_DEFAULT), what);
  std::vector<double> values(count_of(id, what));
  check(H5Aread(id.get(), H5T_NATIVE_DOUBLE, values.data()), what);
  return values;
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

bool has_attribute(const Id& object, const char* attribute) {
  const Lock lock;
  return H5Aexists(object.get(), attribute) > 0;
}

}  // namespace haptrial::record::h5
