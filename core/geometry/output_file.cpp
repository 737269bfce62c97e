#include "core/geometry/output_file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <system_error>
#include <utility>

#include "core/base/error.h"

namespace haptrial::geometry {
namespace fs = std::filesystem;
namespace {

std::string reason(int error) { return std::system_category().message(error); }

}  // namespace

OutputFile::OutputFile(fs::path file, bool overwrite)
    : file_(std::move(file)), overwrite_(overwrite) {
  std::error_code unknown;
  if (fs::is_directory(file_, unknown)) {
    throw InputError(fmt::format("{}: is a folder; give the name of a file", file_.string()));
  }
  if (!overwrite_ && fs::exists(file_, unknown)) {
    throw InputError(fmt::format("{}: exists already; choose another name", file_.string()));
  }
  int descriptor = -1;
  for (int number = 1; descriptor < 0; ++number) {
    part_ = file_.string() + fmt::format(".partial-{}", number);
    descriptor = open(part_.c_str(), O_CREAT | O_EXCL | O_WRONLY | O_CLOEXEC, 0666);
    if (descriptor < 0 && errno != EEXIST) {
      throw InputError(fmt::format("{}: cannot be made: {}", file_.string(), reason(errno)));
    }
  }
  stream_ = fdopen(descriptor, "wb");
  if (stream_ == nullptr) {
    close(descriptor);
    fail("cannot be made");
  }
}

OutputFile::~OutputFile() {
  if (stream_ != nullptr) {
    std::fclose(stream_);
  }
  if (!finished_) {
    std::error_code ignored;
    fs::remove(part_, ignored);
  }
}

void OutputFile::write(std::string_view bytes) {
  if (std::fwrite(bytes.data(), 1, bytes.size(), stream_) != bytes.size()) {
    fail("cannot be written");
  }
}

void OutputFile::release() {
  std::fclose(stream_);
  stream_ = nullptr;
}

void OutputFile::finish() {
  if (stream_ != nullptr) {
    const bool whole = std::fflush(stream_) == 0 && fsync(fileno(stream_)) == 0;
    const int error = errno;
    std::fclose(stream_);
    stream_ = nullptr;
    if (!whole) {
      errno = error;
      fail("cannot be written");
    }
  }
  if (overwrite_) {
    if (rename(part_.c_str(), file_.c_str()) != 0) {
      fail("cannot take its name");
    }
  } else {
    // A link, unlike a renaming, never replaces a file that came meanwhile.
    if (link(part_.c_str(), file_.c_str()) != 0) {
      if (errno == EEXIST) {
        throw InputError(fmt::format("{}: exists already; choose another name", file_.string()));
      }
      if (rename(part_.c_str(), file_.c_str()) != 0) {  // a file system without links
        fail("cannot take its name");
      }
    } else {
      unlink(part_.c_str());
    }
  }
  finished_ = true;
}

void OutputFile::fail(const char* what) const {
  throw RunError(fmt::format("{}: {}: {}", file_.string(), what, reason(errno)));
}

}  // namespace haptrial::geometry
