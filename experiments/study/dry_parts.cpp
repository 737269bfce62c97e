#include "experiments/study/dry_parts.h"

#include <fmt/format.h>

#include <algorithm>
#include <system_error>
#include <utility>

#include "core/base/error.h"
#include "core/base/file_text.h"
#include "core/base/whole_file.h"

namespace haptrial::experiments {
namespace fs = std::filesystem;
namespace {

constexpr const char* kWhat = "dry-run.toml";
constexpr const char* kLocks = "sessions.lock";

/// The folder with its text. @returns it
const fs::path& begun(const fs::path& folder, const std::string& what) {
  std::error_code error;
  const bool other = fs::exists(folder, error) && !fs::exists(folder / kWhat, error) &&
                     (!fs::is_directory(folder, error) || !fs::is_empty(folder, error));
  if (other && !fs::exists(folder / kWhat, error)) {  // not even by now
    throw InputError(
        fmt::format("{}: holds something else; choose a new folder with --parts", folder.string()));
  }
  fs::create_directories(folder, error);
  if (error) {
    throw InputError(fmt::format("{}: cannot be made: {}; choose a folder with write permission",
                                 folder.string(), error.message()));
  }
  if (!fs::exists(folder / kWhat, error)) {
    write_whole(folder / kWhat, what);
  }
  if (file_text(folder / kWhat) != what) {
    throw InputError(fmt::format(
        "{}: holds sessions of another definition, script, seed or program ({} says which); "
        "choose a new folder with --parts",
        folder.string(), kWhat));
  }
  return folder;
}

}  // namespace

DryParts::DryParts(const fs::path& folder, const std::string& what)
    : locks_(begun(folder, what) / kLocks) {}

void DryParts::run(std::size_t number, const fs::path& file, const std::function<void()>& run) {
  const TakenUnit taken(locks_, number);
  if (!taken) {
    const std::lock_guard lock(mutex_);
    elsewhere_.push_back(number);
    return;
  }
  if (!fs::exists(file)) {
    fs::remove(file.string() + ".partial");
    run();
  }
}

std::vector<std::size_t> DryParts::elsewhere() {
  const std::lock_guard lock(mutex_);
  std::vector<std::size_t> all = std::exchange(elsewhere_, {});
  std::ranges::sort(all);
  return all;
}

}  // namespace haptrial::experiments
