#include "tests/core/record/disk_tap.h"

#include <sys/stat.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <atomic>
#include <mutex>
#include <utility>

namespace haptrial::test {
namespace {

struct Tap {
  std::mutex mutex;
  std::atomic<bool> on{false};
  ino_t file{0};
  std::vector<DiskStep> steps;
  std::atomic<bool> stepping{false};
  std::function<void()> step;
  std::function<int(int)> sync;
};

Tap& tap() {
  static Tap* const once = new Tap;  // outlives every thread that writes
  return *once;
}

bool is_ours(int descriptor) {
  struct stat file {};
  return tap().on && fstat(descriptor, &file) == 0 && file.st_ino == tap().file;
}

void note(int descriptor, DiskStep step) {
  if (!is_ours(descriptor)) {
    return;
  }
  const std::lock_guard lock(tap().mutex);
  tap().steps.push_back(std::move(step));
}

void before() {
  if (tap().stepping && tap().step) {
    tap().step();
  }
}

int synced(int descriptor, long call) {
  before();
  note(descriptor, {DiskStep::kSyncBegins, 0, ""});
  const int status = static_cast<int>(syscall(call, descriptor));
  note(descriptor, {DiskStep::kSyncEnds, 0, ""});
  return status;
}

}  // namespace

void DiskTap::start(const std::string& path) {
  struct stat file {};
  const std::lock_guard lock(tap().mutex);
  tap().file = stat(path.c_str(), &file) == 0 ? file.st_ino : 0;
  tap().steps.clear();
  tap().on = true;
}

void DiskTap::mark(std::uint64_t number) {
  const std::lock_guard lock(tap().mutex);
  tap().steps.push_back({DiskStep::kMark, number, ""});
}

std::vector<DiskStep> DiskTap::stop() {
  tap().on = false;
  const std::lock_guard lock(tap().mutex);
  return std::exchange(tap().steps, {});
}

void DiskTap::before_each(std::function<void()> step) {
  tap().stepping = false;
  tap().step = std::move(step);
  tap().stepping = static_cast<bool>(tap().step);
}

void DiskTap::instead_of_fdatasync(std::function<int(int)> sync) {
  const std::lock_guard lock(tap().mutex);
  tap().sync = std::move(sync);
}

}  // namespace haptrial::test

using haptrial::test::DiskStep;

extern "C" {

ssize_t pwrite(int descriptor, const void* bytes, size_t size, off_t offset) {
  haptrial::test::before();
  const ssize_t done = syscall(SYS_pwrite64, descriptor, bytes, size, offset);
  if (done > 0) {
    haptrial::test::note(descriptor,
                         {DiskStep::kWrite, static_cast<std::uint64_t>(offset),
                          std::string(static_cast<const char*>(bytes), static_cast<size_t>(done))});
  }
  return done;
}

int ftruncate(int descriptor, off_t size) noexcept {
  haptrial::test::before();
  const int status = static_cast<int>(syscall(SYS_ftruncate, descriptor, size));
  haptrial::test::note(descriptor, {DiskStep::kTruncate, static_cast<std::uint64_t>(size), ""});
  return status;
}

int fsync(int descriptor) { return haptrial::test::synced(descriptor, SYS_fsync); }

int fdatasync(int descriptor) {
  std::function<int(int)> sync;
  {
    const std::lock_guard lock(haptrial::test::tap().mutex);
    sync = haptrial::test::tap().sync;
  }
  return sync ? sync(descriptor) : haptrial::test::synced(descriptor, SYS_fdatasync);
}

int renameat2(int from_folder, const char* from, int to_folder, const char* to,
              unsigned flags) noexcept {
  haptrial::test::before();
  return static_cast<int>(syscall(SYS_renameat2, from_folder, from, to_folder, to, flags));
}
}
