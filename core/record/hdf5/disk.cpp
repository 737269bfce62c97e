#include "core/record/hdf5/disk.h"

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/statvfs.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <csignal>
#include <system_error>
#include <utility>

namespace haptrial::record {
namespace {

constexpr std::uint64_t kReserve = 256 * 1024;    // index and headers, until the file is closed
constexpr std::uint64_t kStep = 4 * 1024 * 1024;  // taken at once, to call the system rarely

[[noreturn]] void fail(int code) { throw NoSpace(std::generic_category().message(code)); }

/// @returns 0 or the error; a file system that cannot reserve is asked what it has left.
int reserve(int descriptor, std::uint64_t from, std::uint64_t to) {
  if (fallocate(descriptor, FALLOC_FL_KEEP_SIZE, static_cast<off_t>(from),
                static_cast<off_t>(to - from)) == 0) {
    return 0;
  }
  if (errno == ENOSPC || errno == EDQUOT || errno == EFBIG) {
    return errno;
  }
  struct statvfs left {};
  if (fstatvfs(descriptor, &left) != 0) {
    return 0;
  }
  return left.f_bavail * left.f_frsize < to - from ? ENOSPC : 0;
}

}  // namespace

void DiskSpace::ensure(int descriptor, std::uint64_t bytes) {
  struct stat file {};
  if (fstat(descriptor, &file) != 0) {
    fail(errno);
  }
  const std::uint64_t end = static_cast<std::uint64_t>(file.st_size) + bytes + kReserve;
  struct rlimit limit {};
  if (getrlimit(RLIMIT_FSIZE, &limit) == 0 && limit.rlim_cur != RLIM_INFINITY &&
      end > limit.rlim_cur) {
    fail(EFBIG);
  }
  if (end <= reserved_end_) {
    return;
  }
  if (reserve(descriptor, reserved_end_, end + kStep) == 0) {
    reserved_end_ = end + kStep;
    return;
  }
  const int error = reserve(descriptor, reserved_end_, end);
  if (error != 0) {
    fail(error);
  }
  reserved_end_ = end;
}

void probe(int descriptor) {
  std::array<char, 64> head{};
  const ssize_t size = pread(descriptor, head.data(), head.size(), 0);
  if (size < 0 || pwrite(descriptor, head.data(), static_cast<std::size_t>(size), 0) < 0) {
    throw h5::Error(std::generic_category().message(errno));
  }
}

void divert(int descriptor) noexcept {
  const int sink = memfd_create("haptrial", MFD_CLOEXEC);
  if (sink < 0) {
    return;
  }
  dup2(sink, descriptor);
  close(sink);
}

DiskSync::Place place_of(int descriptor, const std::filesystem::path& path) noexcept {
  struct stat opened {
  }, named{};
  if (fstat(descriptor, &opened) != 0) {
    return DiskSync::Place::kThere;
  }  // nothing can be said
  if (stat(path.c_str(), &named) != 0) {
    return errno == ENOENT || errno == ENOTDIR ? DiskSync::Place::kMissing
                                               : DiskSync::Place::kThere;
  }
  const bool same = opened.st_ino == named.st_ino && opened.st_dev == named.st_dev;
  return same ? DiskSync::Place::kThere : DiskSync::Place::kForeign;
}

DiskSync::DiskSync(int descriptor, std::filesystem::path path, std::chrono::milliseconds period)
    : descriptor_(descriptor), path_(std::move(path)), period_(period) {
  thread_ = std::jthread([this](const std::stop_token& stop) { run(stop); });
}

void DiskSync::soon() {
  {
    const std::lock_guard lock(mutex_);
    asked_ = true;
  }
  wake_.notify_one();
}

std::string DiskSync::failure() const {
  const std::lock_guard lock(mutex_);
  return failure_;
}

void DiskSync::run(const std::stop_token& stop) {
  // A signal must not land on a thread that a slow disk holds.
  sigset_t all;
  sigfillset(&all);
  pthread_sigmask(SIG_BLOCK, &all, nullptr);
  for (;;) {
    {
      std::unique_lock lock(mutex_);
      wake_.wait_for(lock, stop, period_, [this] { return asked_; });
      if (stop.stop_requested()) {
        return;
      }
      asked_ = false;
    }
    place_.store(place_of(descriptor_, path_), std::memory_order_relaxed);
    if (fdatasync(descriptor_) != 0) {
      const int code = errno;
      const std::lock_guard lock(mutex_);
      if (failure_.empty()) {
        failure_ = std::generic_category().message(code);
      }
    }
  }
}

}  // namespace haptrial::record
