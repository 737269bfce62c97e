#include "experiments/study/shared_work.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cstdlib>
#include <string_view>
#include <system_error>
#include <utility>

#include "core/base/error.h"
#include "core/base/file_text.h"
#include "core/base/whole_file.h"

namespace haptrial::experiments {
namespace {

/// A lock of the open file and not of the process: closing another description keeps it.
int set_lock(int file, short type, std::size_t byte) {
  struct flock lock {};
  lock.l_type = type;
  lock.l_whence = SEEK_SET;
  lock.l_start = static_cast<off_t>(byte);
  lock.l_len = 1;
  return fcntl(file, F_OFD_SETLK, &lock);
}

}  // namespace

UnitLocks::UnitLocks(const std::filesystem::path& file)
    : file_(open(file.c_str(), O_CREAT | O_RDWR | O_CLOEXEC, 0666)) {}

UnitLocks::~UnitLocks() {
  if (file_ >= 0) {
    close(file_);
  }
}

bool UnitLocks::take(std::size_t unit) const {
  return set_lock(file_, F_WRLCK, unit) == 0 || (errno != EAGAIN && errno != EACCES);
}

void UnitLocks::release(std::size_t unit) const { set_lock(file_, F_UNLCK, unit); }

namespace {

std::optional<int> number_of(const char* text) {
  if (text == nullptr) {
    return std::nullopt;
  }
  const std::string_view digits(text);
  int number = 0;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), number);
  return error == std::errc() && end == digits.data() + digits.size() ? std::optional(number)
                                                                      : std::nullopt;
}

}  // namespace

std::optional<LaunchRank> launch_rank(const std::function<const char*(const char*)>& variable) {
  // srun's come last: mpirun within a batch job inherits those of the job.
  for (const auto& [rank_name, size_name] :
       {std::pair{"OMPI_COMM_WORLD_RANK", "OMPI_COMM_WORLD_SIZE"},
        std::pair{"PMI_RANK", "PMI_SIZE"}, std::pair{"SLURM_PROCID", "SLURM_STEP_NUM_TASKS"}}) {
    const std::optional<int> rank = number_of(variable(rank_name));
    const std::optional<int> size = number_of(variable(size_name));
    if (rank && size && *size > 1 && *rank >= 0 && *rank < *size) {
      return LaunchRank{*rank, *size};
    }
  }
  return std::nullopt;
}

std::optional<LaunchRank> launch_rank() {
  return launch_rank([](const char* name) -> const char* { return std::getenv(name); });
}

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
