#include "core/record/read/readable.h"

#include <algorithm>
#include <system_error>
#include <vector>

#include "core/record/hdf5/hdf5_internal.h"
#include "core/record/hdf5/session_info.h"
#include "core/record/read/isolated.h"
#include "core/record/read/session_reader.h"
#include "core/record/table/schema.h"

namespace haptrial::record {
namespace {

namespace fs = std::filesystem;

/// The first complaint; thrown to leave the walk through the file.
class Complaint : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

std::string attribute_of(const std::string& name, const std::string& object) {
  return "attribute " + name + (object == "/" ? " of the file" : " of " + object);
}

/// Reads an attribute as it is, texts of any length included.
void read_attribute(const h5::Id& object, const std::string& name, const std::string& of) {
  const std::string what = attribute_of(name, of);
  try {
    const h5::Id attribute = h5::take(H5Aopen(object.get(), name.c_str(), H5P_DEFAULT), what);
    const h5::Id type = h5::take(H5Aget_type(attribute.get()), what);
    const h5::Id space = h5::take(H5Aget_space(attribute.get()), what);
    const hssize_t count = H5Sget_simple_extent_npoints(space.get());
    if (count < 0) {
      h5::fail(what);
    }
    std::vector<std::uint8_t> bytes(static_cast<std::size_t>(count) * H5Tget_size(type.get()) + 1);
    h5::check(H5Aread(attribute.get(), type.get(), bytes.data()), what);
    H5Dvlen_reclaim(type.get(), space.get(), H5P_DEFAULT, bytes.data());
  } catch (const h5::Error&) {
    throw Complaint(what + " cannot be read");
  }
}

void read_attributes(const h5::Id& object, const std::string& of) {
  std::vector<std::string> names;
  const herr_t status = H5Aiterate2(
      object.get(), H5_INDEX_NAME, H5_ITER_INC, nullptr,
      [](hid_t, const char* name, const H5A_info_t*, void* out) -> herr_t {
        static_cast<std::vector<std::string>*>(out)->emplace_back(name);
        return 0;
      },
      &names);
  if (status < 0) {
    throw Complaint("the attributes of " + of + " cannot be read");
  }
  for (const std::string& name : names) {
    read_attribute(object, name, of);
  }
}

/// Every row, through HDF5's filters.
void read_rows(const h5::Id& table, const std::string& name) {
  try {
    const h5::Id type = h5::take(H5Dget_type(table.get()), name);
    const h5::Id space = h5::take(H5Dget_space(table.get()), name);
    hsize_t rows = 0;
    h5::check(H5Sget_simple_extent_dims(space.get(), &rows, nullptr), name);
    constexpr hsize_t kRows = 16384;
    std::vector<std::uint8_t> bytes(kRows * H5Tget_size(type.get()));
    for (hsize_t first = 0; first < rows; first += kRows) {
      const hsize_t count = std::min(kRows, rows - first);
      const h5::Id memory = h5::take(H5Screate_simple(1, &count, nullptr), name);
      h5::check(H5Sselect_hyperslab(space.get(), H5S_SELECT_SET, &first, nullptr, &count, nullptr),
                name);
      if (H5Dread(table.get(), type.get(), memory.get(), space.get(), H5P_DEFAULT, bytes.data()) <
          0) {
        throw Complaint("rows of " + name + " from " + std::to_string(first) + " to " +
                        std::to_string(first + count - 1) + " cannot all be read");
      }
    }
  } catch (const h5::Error&) {
    throw Complaint(name + " cannot be read");
  }
}

std::vector<std::string> tables_of(const h5::Id& file) {
  std::vector<std::string> names;
  const herr_t status = H5Literate(
      file.get(), H5_INDEX_NAME, H5_ITER_INC, nullptr,
      [](hid_t, const char* name, const H5L_info_t*, void* out) -> herr_t {
        static_cast<std::vector<std::string>*>(out)->emplace_back(name);
        return 0;
      },
      &names);
  if (status < 0) {
    throw Complaint("the list of its datasets cannot be read");
  }
  return names;
}

/// The root attributes and their copy in /attributes.
void compare_copies(const fs::path& path, const h5::Id& file) {
  if (get_version(file) < 2) {
    return;
  }  // without a copy
  const std::vector<EventRow> attributes = info_rows(get_info(file));
  const std::vector<EventRow> copies = info_rows(SessionReader(path).info());
  for (std::size_t i = 0; i < attributes.size(); ++i) {
    if (attributes[i].text != copies[i].text) {
      throw Complaint(attribute_of(attributes[i].kind, "/") +
                      " differs from its copy in /attributes");
    }
  }
}

std::string complaint_about(const fs::path& path) {
  const h5::Lock lock;
  try {
    const h5::Id file = h5::open_file(path);
    const h5::Id root = h5::take(H5Gopen2(file.get(), "/", H5P_DEFAULT), "/");
    read_attributes(root, "/");
    for (const std::string& name : tables_of(file)) {
      const h5::Id table(H5Dopen2(file.get(), name.c_str(), H5P_DEFAULT));
      if (!table) {
        throw Complaint("/" + name + " cannot be opened");
      }
      read_attributes(table, "/" + name);
      read_rows(table, "/" + name);
    }
    compare_copies(path, file);
  } catch (const Complaint& complaint) {
    return complaint.what();
  } catch (const std::exception&) {
    return "it cannot be opened as a session file";
  }
  return "";
}

}  // namespace

std::optional<std::string> what_cannot_be_read(const fs::path& file) {
  std::error_code ignored;
  const std::uintmax_t size = fs::file_size(file, ignored);
  const auto said =
      in_a_process_of_its_own(ignored ? 0 : size, [&] { return complaint_about(file); });
  if (!said) {
    return "programs that read HDF5 crash on it, or do not come back";
  }
  return said->empty() ? std::nullopt : said;
}

}  // namespace haptrial::record
