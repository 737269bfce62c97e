#include "core/base/whole_file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <system_error>
#include <utility>

#include "core/base/error.h"

namespace haptrial {
namespace fs = std::filesystem;
namespace {

constexpr auto kSameOwner = static_cast<uid_t>(-1);

std::string reason(int error) { return std::system_category().message(error); }

bool is_there(const fs::path& file) noexcept {
  struct stat entry {};
  return lstat(file.c_str(), &entry) == 0;
}

/// The file that a symbolic link stands for; the link itself if there is none.
fs::path target_of(const fs::path& file) {
  std::error_code error;
  const fs::path target = fs::canonical(file, error);
  return error || !fs::is_symlink(file, error) ? file : target;
}

/// Gives a file the mode, the owner and the group of the one that it replaces. Only the superuser
/// may give files away, so for anybody else the owner is the writer; the group stays if the writer
/// is a member of it. Another group may do no more than everybody may.
void keep_access(const fs::path& part, const fs::path& replaced) {
  struct stat before {};
  if (stat(replaced.c_str(), &before) != 0) {
    return;
  }
  mode_t mode = before.st_mode & 0777;
  if (chown(part.c_str(), before.st_uid, before.st_gid) != 0 &&
      chown(part.c_str(), kSameOwner, before.st_gid) != 0) {
    mode = (mode & 0707) | (mode & 07) << 3;
  }
  chmod(part.c_str(), mode);
}

/// Opens a file that was not there and tells its name. Nobody else may read what replaces a
/// private file.
int open_new(const fs::path& file, std::string_view ending, fs::path& part) {
  struct stat before {};
  const mode_t mode = stat(file.c_str(), &before) == 0 ? 0600 : 0666;
  for (int number = 1;; ++number) {
    part = file.string() + fmt::format(".partial-{}{}", number, ending);
    const int descriptor = open(part.c_str(), O_CREAT | O_EXCL | O_WRONLY | O_CLOEXEC, mode);
    if (descriptor >= 0) {
      return descriptor;
    }
    if (errno != EEXIST) {
      throw InputError(fmt::format("{}: cannot be made: {}; choose a folder with write permission",
                                   file.string(), reason(errno)));
    }
  }
}

}  // namespace

WholeFile::WholeFile(fs::path file, bool overwrite, std::string_view ending)
    : file_(std::move(file)), target_(overwrite ? target_of(file_) : file_), overwrite_(overwrite) {
  std::error_code unknown;
  if (fs::is_directory(file_, unknown)) {
    throw InputError(fmt::format("{}: is a folder; give the name of a file", file_.string()));
  }
  if (fs::exists(file_, unknown) && !fs::is_regular_file(file_, unknown)) {
    throw InputError(
        fmt::format("{}: is no regular file, which would be replaced; choose another "
                    "name",
                    file_.string()));
  }
  if (!overwrite_ && is_there(file_)) {
    throw InputError(fmt::format("{}: exists already; choose another name", file_.string()));
  }
  const int descriptor = open_new(target_, ending, part_);
  stream_ = fdopen(descriptor, "wb");
  if (stream_ == nullptr) {
    const int error = errno;
    ::close(descriptor);
    unlink(part_.c_str());
    fail("cannot be made", error);
  }
}

WholeFile::~WholeFile() {
  if (stream_ != nullptr) {
    std::fclose(stream_);
  }
  if (!finished_) {
    unlink(part_.c_str());
  }
}

void WholeFile::write(std::string_view bytes) {
  if (std::fwrite(bytes.data(), 1, bytes.size(), stream_) != bytes.size()) {
    fail("could not be written whole", errno);
  }
}

void WholeFile::close() {
  // Unlike a stream, stdio keeps the error of a failed write until it is asked.
  if (std::fclose(std::exchange(stream_, nullptr)) != 0) {
    fail("could not be written whole", errno);
  }
}

void WholeFile::finish() {
  if (stream_ != nullptr) {
    if (std::fflush(stream_) != 0 || fsync(fileno(stream_)) != 0) {
      fail("could not be written whole", errno);
    }
    close();
  }
  if (overwrite_) {
    keep_access(part_, target_);
  }
  const int error = !overwrite_                                     ? rename_to_new(part_, file_)
                    : ::rename(part_.c_str(), target_.c_str()) != 0 ? errno
                                                                    : 0;
  if (error == EEXIST && !overwrite_) {
    throw InputError(fmt::format("{}: exists already; choose another name", file_.string()));
  }
  if (error != 0) {
    fail("cannot take its name", error);
  }
  finished_ = true;
}

void WholeFile::fail(const char* what, int error) const {
  throw RunError(fmt::format("{}: {}: {}", file_.string(), what, reason(error)));
}

void write_whole(const fs::path& file, std::string_view bytes) {
  WholeFile out(file, true);
  out.write(bytes);
  out.close();
  out.finish();
}

int rename_to_new(const fs::path& from, const fs::path& to) noexcept {
  if (renameat2(AT_FDCWD, from.c_str(), AT_FDCWD, to.c_str(), RENAME_NOREPLACE) == 0) {
    return 0;
  }
  if (errno != EINVAL && errno != ENOSYS) {
    return errno;
  }
  // A file system without the flag: look first, and take the small race.
  if (is_there(to)) {
    return EEXIST;
  }
  return ::rename(from.c_str(), to.c_str()) == 0 ? 0 : errno;
}

}  // namespace haptrial
