// Recovery of a writer whose file is deleted, moved or replaced under it.
#include <fcntl.h>
#include <sys/sendfile.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <string>
#include <system_error>
#include <utility>

#include "core/base/error.h"
#include "core/record/hdf5/session_target.h"
#include "core/record/hdf5/session_writer_impl.h"

namespace haptrial::record {
namespace {

namespace fs = std::filesystem;

[[noreturn]] void fail_with(const std::string& what) {
  throw h5::Error(what + ": " + std::generic_category().message(errno));
}

/// A name for an open file that still has one somewhere.
bool link_back(int descriptor, const fs::path& path) {
  const std::string open_file = "/proc/self/fd/" + std::to_string(descriptor);
  return linkat(AT_FDCWD, open_file.c_str(), AT_FDCWD, path.c_str(), AT_SYMLINK_FOLLOW) == 0;
}

/// Path of an open file now; empty if it was deleted.
fs::path present_path(int descriptor) {
  struct stat file {};
  std::error_code error;
  const fs::path path = fs::read_symlink("/proc/self/fd/" + std::to_string(descriptor), error);
  return error || fstat(descriptor, &file) != 0 || file.st_nlink == 0 ? fs::path() : path;
}

void copy(int from, int to) {
  struct stat file {};
  if (fstat(from, &file) != 0 || ftruncate(to, 0) != 0) {
    fail_with("cannot copy the file");
  }
  off_t at = 0;
  while (at < file.st_size) {
    const ssize_t done = sendfile(to, from, &at, static_cast<std::size_t>(file.st_size - at));
    if (done < 0 && errno != EINTR) {
      fail_with("cannot copy the file");
    }
    if (done == 0) {
      break;
    }
  }
  if (fsync(to) != 0) {
    fail_with("cannot copy the file");
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
  if (place == DiskSync::Place::kForeign) {
    fs::path saved = partial;
    saved += ".saved";
    save_as(saved);
    failure = partial.string() +
              ": was replaced by another file while the session ran; what came " + "before is in " +
              saved.filename().string();
    throw RunError(failure);
  }
  const fs::path present = present_path(lock.descriptor());
  make_folder_again();
  if (link_back(lock.descriptor(), partial)) {
    sync_folder_of(partial);
    notices.push_back(partial.string() + " was moved while the session ran, to " +
                      present.string() + ", and has its name again beside that one");
    return;
  }
  copy_back();
  notices.push_back(partial.filename().string() +
                    " was deleted while the session ran, and was written again with " +
                    "everything that was recorded");
}

/// The folder may have been deleted or renamed with the file. If none can be made, the recording
/// goes to the folder of temporary files.
void SessionWriter::Impl::make_folder_again() {
  const fs::path folder = folder_of(partial);
  std::error_code error;
  const bool made = fs::create_directories(folder, error);
  if (made) {
    notices.push_back("the folder " + folder.string() +
                      " was deleted or moved while the session ran, and was made again");
  }
  if (!error) {
    return;
  }
  fs::path saved = present_path(lock.descriptor());
  if (saved.empty()) {
    saved = fs::temp_directory_path() / partial.filename();
    saved += "." + std::to_string(getpid());
    save_as(saved);
  }
  failure = "the folder " + folder.string() +
            " was deleted or moved while the session ran, and cannot be made again (" +
            error.message() + "); what came before is in " + saved.string();
  throw RunError(failure);
}

/// Writes everything so far, and gives the file another name or copies it.
void SessionWriter::Impl::save_as(const fs::path& saved) {
  write(true);
  if (!link_back(lock.descriptor(), saved)) {
    FileLock to = FileLock::take(saved, true);
    copy(lock.descriptor(), to.descriptor());
  }
  sync_folder_of(saved);
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
