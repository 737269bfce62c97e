#include "analysis/files/new_folder.h"

#include <fmt/format.h>
#include <unistd.h>

#include <system_error>

#include "core/base/error.h"
#include "core/base/file_text.h"

namespace haptrial::exchange {
namespace {

namespace fs = std::filesystem;

fs::path without_trailing_slash(const fs::path& path) {
  const fs::path whole = fs::absolute(path).lexically_normal();
  return whole.has_filename() ? whole : whole.parent_path();
}

}  // namespace

NewFolder::NewFolder(const fs::path& folder) : final_(without_trailing_slash(folder)) {
  std::error_code error;
  if (fs::exists(final_, error) && !fs::is_directory(final_, error)) {
    throw InputError(
        fmt::format("{}: is not a folder; choose a new or an empty folder", final_.string()));
  }
  if (fs::is_directory(final_, error) && !fs::is_empty(final_, error)) {
    throw InputError(
        fmt::format("{}: is not empty; choose a new or an empty folder", final_.string()));
  }
  staging_ =
      final_.parent_path() / fmt::format(".{}.partial-{}", final_.filename().string(), getpid());
  fs::remove_all(staging_, error);
  fs::create_directories(staging_, error);
  if (error || !fs::is_directory(staging_)) {
    throw InputError(
        fmt::format("{}: cannot be created ({}); choose a folder with write permission",
                    final_.string(), error.message()));
  }
}

NewFolder::~NewFolder() {
  if (!published_) {
    std::error_code ignored;
    fs::remove_all(staging_, ignored);
  }
}

fs::path NewFolder::place(const fs::path& name) const {
  const fs::path file = staging_ / name;
  std::error_code error;
  fs::create_directories(file.parent_path(), error);
  if (error) {
    throw RunError(
        fmt::format("{}: cannot be made: {}", file.parent_path().string(), error.message()));
  }
  return file;
}

void NewFolder::write(const fs::path& name, std::string_view text) const {
  write_text(place(name), text, final_ / name);
}

void NewFolder::publish() {
  std::error_code error;
  fs::rename(staging_, final_, error);  // takes the place of an empty folder, of no other
  if (error) {
    throw RunError(
        fmt::format("{}: could not be put in place: {}", final_.string(), error.message()));
  }
  published_ = true;
}

}  // namespace haptrial::exchange
