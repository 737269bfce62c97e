// What a writer does when its file is deleted, moved or replaced under it.
#include <fcntl.h>
#include <sys/sendfile.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <string>
#include <system_error>
#include <utility>

#include "core/base/error.h"
#include "core/record/write/session_target.h"
#include "core/record/write/session_writer_impl.h"

namespace haptrial::record {
namespace {

namespace fs = std::filesystem;

[[noreturn]] void fail(const std::string& what) {
  throw h5::Error(what + ": " + std::generic_category().message(errno));
}

/// A name for an open file that still has one somewhere.
bool link_back(int descriptor, const fs::path& path) {
  const std::string open_file = "/proc/self/fd/" + std::to_string(descriptor);
  return linkat(AT_FDCWD, open_file.c_str(), AT_FDCWD, path.c_str(), AT_SYMLINK_FOLLOW) == 0;
}

void copy(int from, int to) {
  struct stat file {};
  if (fstat(from, &file) != 0 || ftruncate(to, 0) != 0) {
    fail("cannot copy the file");
  }
  off_t at = 0;
  while (at < file.st_size) {
    const ssize_t done = sendfile(to, from, &at, static_cast<std::size_t>(file.st_size - at));
    if (done < 0 && errno != EINTR) {
      fail("cannot copy the file");
    }
    if (done == 0) {
      break;
    }
  }
  if (fsync(to) != 0) {
    fail("cannot copy the file");
  }
}

}  // namespace

void SessionWriter::Impl::heed_disk() {
  if (!syncing) {
    return;
  }
  if (const std::string failed = syncing->failure(); !failed.empty()) {
    throw h5::Error(failed);
  }
  if (syncing->place() != DiskSync::Place::kThere) {
    put_back();
  }
}

void SessionWriter::Impl::put_back() {
  const DiskSync::Place place = place_of(lock.descriptor(), partial);
  if (place == DiskSync::Place::kThere) {
    return;
  }
  const std::string name = partial.filename().string();
  if (place == DiskSync::Place::kForeign) {
    write(true);
    fs::path saved = partial;
    saved += ".saved";
    if (!link_back(lock.descriptor(), saved)) {
      FileLock to = FileLock::take(saved, true);
      copy(lock.descriptor(), to.descriptor());
    }
    sync_folder_of(saved);
    failure = partial.string() +
              ": was replaced by another file while the session ran; what came " + "before is in " +
              saved.filename().string();
    throw RunError(failure);
  }
  if (link_back(lock.descriptor(), partial)) {
    sync_folder_of(partial);
    notices.push_back(name + " was moved while the session ran, and has its name again");
    return;
  }
  copy_back();
  notices.push_back(name + " was deleted while the session ran, and was written again with " +
                    "everything that was recorded");
}

/// A file without a name cannot get one again: a copy goes on in its place.
void SessionWriter::Impl::copy_back() {
  write(true);
  close_tables();
  h5::close(file);
  syncing.reset();
  const fs::path created = new_path(final_path);
  FileLock copied = FileLock::take(created, true);
  copy(lock.descriptor(), copied.descriptor());
  give_name(created, partial);
  lock = std::move(copied);
  sync_folder_of(partial);
  go_on();
}

}  // namespace haptrial::record
