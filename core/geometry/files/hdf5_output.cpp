#include <fmt/format.h>
#include <hdf5.h>

#include <mutex>

#include "core/base/error.h"
#include "core/geometry/files/hdf5_output.h"

namespace haptrial::geometry::h5 {
namespace {

/// One call at a time, without HDF5's own printing of errors.
class Hdf5Lock {
 public:
  Hdf5Lock() : hold_(mutex()) { H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr); }

 private:
  static std::recursive_mutex& mutex() {
    static std::recursive_mutex one;
    return one;
  }
  std::lock_guard<std::recursive_mutex> hold_;
};

/// Closes an identifier with the function of its kind.
class Id {
 public:
  Id(hid_t id, herr_t (*close)(hid_t)) : id_(id), close_(close) {}
  ~Id() {
    if (id_ >= 0) {
      close_(id_);
    }
  }
  Id(const Id&) = delete;
  Id& operator=(const Id&) = delete;
  operator hid_t() const { return id_; }  // NOLINT: stands for the identifier

 private:
  hid_t id_;
  herr_t (*close_)(hid_t);
};

hid_t in_memory(Number type) {
  switch (type) {
    case Number::kU8:
      return H5T_NATIVE_UINT8;
    case Number::kI32:
      return H5T_NATIVE_INT32;
    case Number::kF32:
      return H5T_NATIVE_FLOAT;
    case Number::kF64:
      break;
  }
  return H5T_NATIVE_DOUBLE;
}

}  // namespace

File::File(std::filesystem::path path) : path_(std::move(path)), id_(-1) {
  const Hdf5Lock lock;
  id_ = H5Fcreate(path_.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT);
  if (id_ < 0) {
    fail("cannot be made");
  }
}

File::~File() {
  const Hdf5Lock lock;
  if (id_ >= 0) {
    H5Fclose(id_);
  }
}

void File::write(const char* dataset, Number type, const std::vector<std::uint64_t>& shape,
                 const void* values) {
  const Hdf5Lock lock;
  const std::vector<hsize_t> sizes(shape.begin(), shape.end());
  const Id space(H5Screate_simple(static_cast<int>(sizes.size()), sizes.data(), nullptr), H5Sclose);
  const Id data(
      H5Dcreate2(id_, dataset, in_memory(type), space, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT),
      H5Dclose);
  if (data < 0 || H5Dwrite(data, in_memory(type), H5S_ALL, H5S_ALL, H5P_DEFAULT, values) < 0) {
    fail("cannot be written");
  }
}

void File::put(const char* dataset, const char* attribute, const std::string& text) {
  const Hdf5Lock lock;
  const Id data(H5Dopen2(id_, dataset, H5P_DEFAULT), H5Dclose);
  const Id type(H5Tcopy(H5T_C_S1), H5Tclose);
  H5Tset_size(type, text.size() + 1);
  const Id space(H5Screate(H5S_SCALAR), H5Sclose);
  const Id put_here(H5Acreate2(data, attribute, type, space, H5P_DEFAULT, H5P_DEFAULT), H5Aclose);
  if (put_here < 0 || H5Awrite(put_here, type, text.c_str()) < 0) {
    fail("cannot be written");
  }
}

void File::put(const char* dataset, const char* attribute, const std::vector<double>& values) {
  const Hdf5Lock lock;
  const Id data(H5Dopen2(id_, dataset, H5P_DEFAULT), H5Dclose);
  const hsize_t size = values.size();
  const Id space(H5Screate_simple(1, &size, nullptr), H5Sclose);
  const Id put_here(H5Acreate2(data, attribute, H5T_NATIVE_DOUBLE, space, H5P_DEFAULT, H5P_DEFAULT),
                    H5Aclose);
  if (put_here < 0 || H5Awrite(put_here, H5T_NATIVE_DOUBLE, values.data()) < 0) {
    fail("cannot be written");
  }
}

void File::close() {
  const Hdf5Lock lock;
  const hid_t id = id_;
  id_ = -1;
  if (H5Fclose(id) < 0) {
    fail("cannot be written completely");
  }
}

void File::fail(const char* what) const {
  throw RunError(fmt::format("{}: {}; is there room on the disk?", path_.string(), what));
}

}  // namespace haptrial::geometry::h5
