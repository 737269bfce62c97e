#include "core/record/hdf5/disk_sync.h"

#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <system_error>
#include <utility>

namespace haptrial::record {

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
  thread_ = std::thread([this] { run(); });
}

DiskSync::~DiskSync() {
  {
    const std::lock_guard lock(mutex_);
    stop_ = true;
  }
  wake_.notify_one();
  thread_.join();
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

void DiskSync::run() {
  // A signal must not land on a thread that a slow disk holds.
  sigset_t all;
  sigfillset(&all);
  pthread_sigmask(SIG_BLOCK, &all, nullptr);
  for (;;) {
    {
      std::unique_lock lock(mutex_);
      wake_.wait_for(lock, period_, [this] { return asked_ || stop_; });
      if (stop_) {
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
