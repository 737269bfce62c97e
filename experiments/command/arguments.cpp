#include "experiments/command/arguments.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <filesystem>
#include <limits>

#include "core/base/error.h"
#include "core/base/parallel.h"

namespace haptrial::experiments {

int checked_number(const char* what, int value, int low, int high) {
  if (value < low || value > high) {
    throw InputError(
        fmt::format("{} is {}; allowed: a whole number from {} to {}", what, value, low, high));
  }
  return value;
}

double checked_real(const char* what, double value, double low, double high) {
  if (!(value >= low && value <= high)) {
    throw InputError(
        fmt::format("{} is {}; allowed: a number from {} to {}", what, value, low, high));
  }
  return value;
}

std::uint64_t checked_seed(const std::string& text) {
  std::uint64_t seed = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), seed);
  if (error != std::errc() || end != text.data() + text.size()) {
    throw InputError(fmt::format("--seed is '{}'; allowed: a whole number from 0 to {}", text,
                                 std::numeric_limits<std::uint64_t>::max()));
  }
  return seed;
}

void check_new(const std::string& file, bool overwrite) {
  if (!file.empty() && !overwrite && std::filesystem::exists(file)) {
    throw InputError(
        fmt::format("{}: exists already; choose another name or add --overwrite", file));
  }
}

void check_new_figure(const std::string& file, bool overwrite) {
  const std::string ending = std::filesystem::path(file).extension().string();
  if (!file.empty() && ending != ".png" && ending != ".svg") {
    throw InputError(fmt::format("{}: ends in '{}'; allowed: .png, .svg", file, ending));
  }
  check_new(file, overwrite);
}

int checked_jobs(std::optional<int> jobs) {
  constexpr int kMostJobs = 256;
  const int processors = threads_or_all(0);
  return jobs ? checked_number("--jobs", *jobs, 1, kMostJobs) : std::min(processors, kMostJobs);
}

}  // namespace haptrial::experiments
