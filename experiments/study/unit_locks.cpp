#include "experiments/study/unit_locks.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>

namespace haptrial::experiments {
namespace {

/// A lock of the open file and not of the process: closing another description keeps it.
int set_lock(int file, short type, std::size_t byte) {
  struct flock lock {};
  lock.l_type = type;
  lock.l_whence = SEEK_SET;
  lock.l_start = static_cast<off_t>(byte);
  lock.l_len = 1;
  return fcntl(file, F_OFD_SETLK, &lock);
}

}  // namespace

UnitLocks::UnitLocks(const std::filesystem::path& file)
    : file_(open(file.c_str(), O_CREAT | O_RDWR | O_CLOEXEC, 0666)) {}

UnitLocks::~UnitLocks() {
  if (file_ >= 0) {
    close(file_);
  }
}

bool UnitLocks::take(std::size_t unit) const {
  return set_lock(file_, F_WRLCK, unit) == 0 || (errno != EAGAIN && errno != EACCES);
}

void UnitLocks::release(std::size_t unit) const { set_lock(file_, F_UNLCK, unit); }

}  // namespace haptrial::experiments
