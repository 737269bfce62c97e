#include <array>
#include <cerrno>
#include <fstream>
#include <system_error>

#include "core/base/file_text.h"
#include "core/record/hdf5/file_lock.h"
#include "core/record/hdf5/hdf5_internal.h"
#include "core/record/hdf5/hdf5_layer.h"

namespace haptrial::record::h5 {
namespace {

Id access_list() {
  Id list = take(H5Pcreate(H5P_FILE_ACCESS), "file access list");
  check(H5Pset_libver_bounds(list.get(), H5F_LIBVER_V110, H5F_LIBVER_V110), "library version");
  // A file system without locks must not keep a session from being recorded.
  check(H5Pset_file_locking(list.get(), true, true), "file locking");
  // A kill can cut a write between two pages of the system: what HDF5 reads with a checksum, such
  // as the header of a table, therefore lies within one.
  constexpr hsize_t kPage = 4096;
  constexpr hsize_t kSmallest = 512;  // smaller pieces share a page of their own
  check(H5Pset_alignment(list.get(), kSmallest, kPage), "alignment");
  return list;
}

/// Whether the superblock (version 3) carries the marks of a SWMR writer: the bits 0 and 2 of
/// byte 11.
bool marked_as_written(const std::filesystem::path& path) {
  std::array<char, 12> head{};
  std::ifstream in(path, std::ios::binary);
  return in.read(head.data(), head.size()) && head[8] == 3 && (head[11] & 5) == 5;
}

}  // namespace

Id create_file(const std::filesystem::path& path, bool over) {
  const Lock lock;
  const Id access = access_list();
  const unsigned flags = over ? H5F_ACC_TRUNC : H5F_ACC_EXCL;
  return take(H5Fcreate(path.c_str(), flags, H5P_DEFAULT, access.get()), "cannot create");
}

Id open_to_go_on(const std::filesystem::path& path) {
  const Lock lock;
  const Id access = access_list();
  // The marks are cleared as HDF5's own tool h5clear does: a killed writer leaves them in the
  // superblock, and there an end of file that lies before its last writes.
  hbool_t yes = true;
  check(H5Pset(access.get(), "clear_status_flags", &yes), "status flags");
  check(H5Pset(access.get(), "skip_eof_check", &yes), "end of file");
  // Ordered from the first write on: a kill in between leaves the file as readable as it was.
  const unsigned flags = H5F_ACC_RDWR | H5F_ACC_SWMR_WRITE;
  Id file(H5Fopen(path.c_str(), flags, access.get()));
  if (!file) {
    const std::string why = reason();
    if (why == std::generic_category().message(EAGAIN)) {
      throw InUseError(why);
    }
    throw Error("cannot open for writing: " + why);
  }
  check(H5Fincrement_filesize(file.get(), 0), "end of file");
  return file;
}

Id open_file(const std::filesystem::path& path) {
  refuse_special_file(path);
  const Lock lock;
  const Id access = access_list();
  Id file(H5Fopen(path.c_str(), H5F_ACC_RDONLY, access.get()));
  if (file) {
    return file;
  }
  const std::string first = reason();
  // A file whose writer was killed or is still at work opens only as a SWMR reader, which reads
  // what looks torn again after 1, 2, 4, ... ns: 24 times make 17 ms, HDF5's own 100 for ever. If
  // nobody writes, nothing becomes whole, and a damaged index costs the time for each chunk.
  check(H5Pset_metadata_read_attempts(access.get(), FileLock::certainly_free(path) ? 1 : 24),
        "read attempts");
  if (marked_as_written(path)) {
    file = Id(H5Fopen(path.c_str(), H5F_ACC_RDONLY | H5F_ACC_SWMR_READ, access.get()));
  }
  if (!file) {
    throw Error(first);
  }
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
  if (!file.reset()) {
    fail("cannot close");
  }
}

int descriptor(const Id& file) {
  const Lock lock;
  void* handle = nullptr;
  check(H5Fget_vfd_handle(file.get(), H5P_DEFAULT, &handle), "no file descriptor");
  return *static_cast<int*>(handle);
}

}  // namespace haptrial::record::h5
