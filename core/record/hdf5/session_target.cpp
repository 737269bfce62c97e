#include "core/record/hdf5/session_target.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <string>
#include <system_error>

#include "core/base/error.h"
#include "core/base/whole_file.h"
#include "core/record/hdf5/file_lock.h"
#include "core/record/hdf5/hdf5_layer.h"

namespace haptrial::record {
namespace {

namespace fs = std::filesystem;

fs::path with(const fs::path& path, const char* ending) {
  fs::path result = path;
  result += ending;
  return result;
}

bool is_there(const fs::path& path) {
  std::error_code ignored;
  return fs::symlink_status(path, ignored).type() != fs::file_type::not_found;
}

void sync(const fs::path& path, int flags) {
  const int descriptor = open(path.c_str(), flags | O_CLOEXEC);
  if (descriptor < 0) {
    throw h5::Error(std::generic_category().message(errno));
  }
  const int status = fsync(descriptor);
  const int code = errno;
  close(descriptor);
  if (status != 0) {
    throw h5::Error(std::generic_category().message(code));
  }
}

}  // namespace

fs::path partial_path(const fs::path& final_path) { return with(final_path, ".partial"); }
fs::path new_path(const fs::path& final_path) { return with(final_path, ".partial.new"); }

fs::path folder_of(const fs::path& file) {
  return file.has_parent_path() ? file.parent_path() : fs::path(".");
}

void check_target(const fs::path& final_path) {
  const std::string name = final_path.string();
  const fs::path partial = partial_path(final_path);
  const fs::path folder = folder_of(final_path);
  std::error_code ignored;
  if (!final_path.has_filename()) {
    throw InputError(name + ": gives no file name; choose a file in an existing folder");
  }
  if (!fs::is_directory(folder, ignored)) {
    throw InputError(name + ": the folder " + folder.string() +
                     " does not exist; create it or choose another folder");
  }
  if (is_there(final_path)) {
    throw InputError(name + ": exists already; choose another file");
  }
  if (is_there(partial)) {
    throw InputError(
        partial.string() + ": exists already, " +
        (FileLock::taken(partial)
             ? "and another haptrial records into it; choose another file"
             : "from an unfinished session; resume that session or choose another file"));
  }
  if (access(folder.c_str(), W_OK | X_OK) != 0) {
    throw InputError(name + ": the folder " + folder.string() +
                     " may not be written; choose a folder with write permission");
  }
}

void give_name(const fs::path& from, const fs::path& to) {
  if (const int error = rename_to_new(from, to); error != 0) {
    throw h5::Error("cannot rename to " + to.string() + ": " +
                    std::generic_category().message(error));
  }
}

void sync_data(int descriptor) {
  if (fdatasync(descriptor) != 0) {
    throw h5::Error(std::generic_category().message(errno));
  }
}

void sync_file(const fs::path& file) { sync(file, O_RDWR); }
void sync_folder_of(const fs::path& file) { sync(folder_of(file), O_RDONLY | O_DIRECTORY); }

void trim(const fs::path& path) noexcept {
  struct stat file {};
  if (stat(path.c_str(), &file) == 0 && truncate(path.c_str(), file.st_size) != 0) {
    errno = 0;
  }
}

}  // namespace haptrial::record
