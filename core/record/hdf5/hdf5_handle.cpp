#include "core/record/hdf5/hdf5_handle.h"

#include <hdf5.h>

#include <utility>

namespace haptrial::record::h5 {
namespace {

std::recursive_mutex& process_mutex() {
  static std::recursive_mutex mutex;
  return mutex;
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
  if (id < 0) {
    return true;
  }
  const Lock lock;
  const H5I_type_t type = H5Iget_type(id);
  if (type == H5I_FILE) {
    return H5Fclose(id) >= 0;
  }
  if (type == H5I_DATASET) {
    return H5Dclose(id) >= 0;
  }
  return H5Idec_ref(id) >= 0;
}

}  // namespace haptrial::record::h5
