#include "analysis/files/staging.h"

#include <fmt/format.h>
#include <unistd.h>

#include <system_error>
#include <vector>

#include "core/base/error.h"
#include "core/base/file_text.h"

namespace haptrial::analysis {

namespace fs = std::filesystem;

Staging::Staging(const fs::path& folder)
    : final_(folder), path_(folder / fmt::format(".analysis-{}", getpid())) {
  std::error_code error;
  fs::create_directories(final_, error);
  if (!fs::is_directory(final_)) {
    throw InputError(fmt::format(
        "{}: is not a folder and cannot be created ({}); choose a folder with write permission",
        final_.string(), error.message()));
  }
  fs::remove_all(path_, error);
  if (!fs::create_directory(path_, error)) {
    throw InputError(
        fmt::format("{}: cannot be written ({}); choose a folder with write permission",
                    final_.string(), error.message()));
  }
}

Staging::~Staging() {
  std::error_code ignored;
  fs::remove_all(path_, ignored);
}

void Staging::write(const std::string& name, const std::string& text) const {
  write_text(path_ / name, text, final_ / name);
}

void Staging::append(const std::string& name, const std::string& text) const {
  append_text(path_ / name, text, final_ / name);
}

void Staging::publish() const {
  std::vector<fs::path> files;
  for (const auto& entry : fs::directory_iterator(path_)) {
    files.push_back(entry.path().filename());
  }
  for (const auto& name : files) {
    std::error_code error;
    fs::rename(path_ / name, final_ / name, error);
    if (error) {
      throw RunError(fmt::format("{}: could not be put in place: {}", (final_ / name).string(),
                                 error.message()));
    }
  }
}

}  // namespace haptrial::analysis
