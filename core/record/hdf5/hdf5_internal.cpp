#include "core/record/hdf5/hdf5_internal.h"

#include <string_view>

namespace haptrial::record::h5 {

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

void fail(const std::string& what) { throw Error(what + ": " + reason()); }

Id take(hid_t id, const std::string& what) {
  if (id < 0) {
    fail(what);
  }
  return Id(id);
}

void check(herr_t status, const std::string& what) {
  if (status < 0) {
    fail(what);
  }
}

}  // namespace haptrial::record::h5
