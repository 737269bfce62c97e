#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <chrono>
#include <filesystem>
#include <map>
#include <set>

#include "experiments/command/subcommand.h"
#include "experiments/power/power_folder.h"
#include "experiments/power/power_part.h"

namespace haptrial::experiments {
namespace fs = std::filesystem;
namespace {

int power_status(const std::string& path) {
  const PowerQuestion question = PowerFolder::question_of(path);
  const PowerFolder folder(path, question);
  std::set<std::string> missing;
  for (const PowerUnit& unit : folder.missing()) {
    missing.insert(unit.file());
  }
  std::map<std::string, std::size_t> failures;
  fs::file_time_type first = fs::file_time_type::max(), last = fs::file_time_type::min();
  for (const PowerUnit& unit : folder.units()) {
    if (missing.contains(unit.file())) {
      continue;
    }
    const fs::path file = folder.path() / "parts" / unit.file();
    first = std::min(first, fs::last_write_time(file));
    last = std::max(last, fs::last_write_time(file));
    for (const SimulatedStudy& study : read_part(file, question, unit)) {
      for (const std::string& reason : study.failures) {
        ++failures[reason];
      }
    }
  }
  const std::size_t all = folder.units().size(), done = all - missing.size();
  fmt::print("{} of {} parts ({:.1f} %)\n", done, all,
             100.0 * static_cast<double>(done) / static_cast<double>(all));
  const double seconds = done > 1 ? std::chrono::duration<double>(last - first).count() : 0.0;
  if (seconds > 0.0) {
    const double rate = static_cast<double>(done - 1) / seconds;
    fmt::print("{:.3g} parts a minute; {:.3g} minutes are left at this rate\n", 60.0 * rate,
               static_cast<double>(missing.size()) / rate / 60.0);
  }
  for (const auto& [reason, count] : failures) {
    fmt::print("failed {} times: {}\n", count, reason);
  }
  fmt::print("next: haptrial power {} {}\n", missing.empty() ? "merge" : "status", path);
  return 0;
}

}  // namespace

void add_power_status(CLI::App& power, int& status) {
  CLI::App* sub = subcommand(power, "status", "Print how far a simulation is",
                             "haptrial power status out/repetition", {"", "guide-power.md"});
  auto& folder = options_of<std::string>(*sub, status, power_status);
  sub->add_option("DIR", folder, "Folder of a simulation")->required();
}

}  // namespace haptrial::experiments
