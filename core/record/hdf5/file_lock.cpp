#include "core/record/hdf5/file_lock.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <optional>
#include <system_error>
#include <utility>

#include "core/base/error.h"

namespace haptrial::record {
namespace {

/// An open file description lock (fcntl): unlike a lock of the process it outlives the closing of
/// other descriptors of the file, as readers within this process do.
struct flock whole_file() {
  struct flock lock {};
  lock.l_type = F_WRLCK;
  lock.l_whence = SEEK_SET;
  return lock;
}

/// Whether the path still leads to what was opened: its owner may have renamed it meanwhile.
bool still_there(int descriptor, const std::filesystem::path& file) {
  struct stat opened {
  }, named{};
  return fstat(descriptor, &opened) == 0 && stat(file.c_str(), &named) == 0 &&
         opened.st_ino == named.st_ino && opened.st_dev == named.st_dev;
}

/// Type of the lock that another description of the file has; nothing if it cannot be asked.
std::optional<int> lock_type_of(int descriptor) {
  struct flock whole = whole_file();
  const bool asked = descriptor >= 0 && fcntl(descriptor, F_OFD_GETLK, &whole) == 0;
  return asked ? std::optional<int>(whole.l_type) : std::nullopt;
}

}  // namespace

FileLock::~FileLock() {
  if (descriptor_ >= 0) {
    close(descriptor_);
  }
}

FileLock& FileLock::operator=(FileLock&& other) noexcept {
  if (this != &other) {
    if (descriptor_ >= 0) {
      close(descriptor_);
    }
    descriptor_ = std::exchange(other.descriptor_, -1);
  }
  return *this;
}

FileLock FileLock::take(const std::filesystem::path& file, bool create) {
  const int flags = O_RDWR | O_CLOEXEC | (create ? O_CREAT : 0);
  FileLock lock(open(file.c_str(), flags, 0666));
  if (lock.descriptor_ < 0) {
    throw RunError(file.string() + ": cannot be opened (" + std::generic_category().message(errno) +
                   ")");
  }
  struct flock whole = whole_file();
  const bool refused = fcntl(lock.descriptor_, F_OFD_SETLK, &whole) != 0;
  // A file system without locks must not keep a session from being recorded.
  if ((refused && (errno == EAGAIN || errno == EACCES)) || !still_there(lock.descriptor_, file)) {
    throw InputError(file.string() +
                     ": is in use by another haptrial; wait until it ends or choose another file");
  }
  return lock;
}

bool FileLock::taken(const std::filesystem::path& file) {
  return lock_type_of(FileLock(open(file.c_str(), O_RDONLY | O_CLOEXEC)).descriptor_)
             .value_or(F_UNLCK) != F_UNLCK;
}

bool FileLock::certainly_free(const std::filesystem::path& file) {
  return lock_type_of(FileLock(open(file.c_str(), O_RDONLY | O_CLOEXEC)).descriptor_) == F_UNLCK;
}

}  // namespace haptrial::record
