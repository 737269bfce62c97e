#include "experiments/study/backup.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <string_view>
#include <system_error>
#include <utility>
#include <vector>

#include "core/base/error.h"
#include "core/base/exception_words.h"
#include "core/base/file_text.h"
#include "core/base/whole_file.h"

namespace haptrial::experiments {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kAtOnce = std::size_t{1} << 20;  // bytes

[[noreturn]] void fail(const fs::path& file, const char* what, int error) {
  throw RunError(
      fmt::format("{}: {} ({})", file.string(), what, std::system_category().message(error)));
}

/// An open file, or folder, closed at the end.
class OpenFile {
 public:
  OpenFile(fs::path path, int flags) : path_(std::move(path)) {
    do {
      file_ = ::open(path_.c_str(), flags | O_CLOEXEC, 0666);
    } while (file_ < 0 && errno == EINTR);
    if (file_ < 0) {
      fail(path_, (flags & O_CREAT) != 0 ? "cannot be made" : "cannot be opened", errno);
    }
  }
  ~OpenFile() { ::close(file_); }
  OpenFile(const OpenFile&) = delete;
  OpenFile& operator=(const OpenFile&) = delete;

  /// @returns as many bytes as the buffer has, or fewer at the end of the file
  std::string_view read(std::vector<char>& buffer) const {
    std::size_t count = 0;
    while (count < buffer.size()) {
      const ssize_t got = ::read(file_, buffer.data() + count, buffer.size() - count);
      if (got < 0 && errno != EINTR) {
        fail(path_, "cannot be read", errno);
      }
      if (got == 0) {
        break;
      }
      count += got > 0 ? static_cast<std::size_t>(got) : 0;
    }
    return {buffer.data(), count};
  }
  void write(std::string_view bytes) const {
    while (!bytes.empty()) {
      const ssize_t count = ::write(file_, bytes.data(), bytes.size());
      if (count < 0 && errno != EINTR) {
        fail(path_, "cannot be written", errno);
      }
      bytes.remove_prefix(count > 0 ? static_cast<std::size_t>(count) : 0);
    }
  }
  /// Waits until the disk has it.
  void sync() const {
    if (::fsync(file_) != 0 && errno != EINVAL && errno != ENOTSUP) {  // not kept by every system
      fail(path_, "cannot be synced", errno);
    }
  }
  /// Lets what is read next come from the disk and not from memory, where the system can do so.
  void forget() const { ::posix_fadvise(file_, 0, 0, POSIX_FADV_DONTNEED); }

 private:
  fs::path path_;
  int file_{-1};
};

void copy_bytes(const fs::path& from, const fs::path& to) {
  const OpenFile in(from, O_RDONLY);
  const OpenFile out(to, O_WRONLY | O_CREAT | O_TRUNC);
  std::vector<char> buffer(kAtOnce);
  for (std::string_view part = in.read(buffer); !part.empty(); part = in.read(buffer)) {
    out.write(part);
  }
  out.sync();
  out.forget();
}

bool same_bytes(const fs::path& a, const fs::path& b) {
  const OpenFile first(a, O_RDONLY);
  const OpenFile second(b, O_RDONLY);
  std::vector<char> one(kAtOnce), other(kAtOnce);
  while (true) {
    const std::string_view part = first.read(one);
    if (part != second.read(other)) {
      return false;
    }
    if (part.empty()) {
      return true;
    }
  }
}

void refuse_other_copy(const fs::path& session, const fs::path& copy) {
  refuse_special_file(copy);
  if (!same_bytes(session, copy)) {
    throw RunError(
        fmt::format("{}: is another file of this name, which is kept as it is", copy.string()));
  }
}

/// Makes the copy under its temporary name, and gives it its own when it is whole.
void place(const fs::path& session, const fs::path& part, const fs::path& copied) {
  copy_bytes(session, part);
  if (!same_bytes(session, part)) {
    throw RunError(fmt::format("{}: does not read back as it was written", part.string()));
  }
  if (const int error = rename_to_new(part, copied); error != 0) {
    fail(copied, "cannot take its name", error);
  }
  OpenFile(copied.parent_path(), O_RDONLY | O_DIRECTORY).sync();
}

}  // namespace

fs::path back_up(const fs::path& session, const fs::path& folder, const std::string& study) {
  std::error_code error;
  if (!fs::is_directory(folder, error)) {
    throw RunError(
        fmt::format("{}: is not a folder that is there; is its disk plugged in?", folder.string()));
  }
  const fs::path own = folder / study;
  fs::create_directory(own, error);
  if (error) {
    fail(own, "cannot be made", error.value());
  }
  const fs::path copied = own / session.filename();
  if (fs::exists(fs::symlink_status(copied, error))) {
    refuse_other_copy(session, copied);
    return copied;
  }
  const fs::path part = copied.string() + ".copying";
  fs::remove(part, error);
  try {
    place(session, part, copied);
  } catch (...) {
    fs::remove(part, error);
    throw;
  }
  return copied;
}

BackupResult try_back_up(const fs::path& session, const fs::path& folder,
                         const std::string& study) {
  try {
    const fs::path copied = back_up(session, folder, study);
    return {true, fmt::format("backup: {}, compared byte by byte", copied.string())};
  } catch (const std::exception& error) {
    return {false, fmt::format("WARNING: THE SESSION HAS NO BACKUP: {}\n"
                               "The session itself is whole: {}\n"
                               "Copy it by hand to another disk before the next participant comes.",
                               sentence_of(error), session.string())};
  }
}

}  // namespace haptrial::experiments
