#include "experiments/power/power_folder.h"

#include <fmt/format.h>

#include <set>
#include <system_error>

#include "core/base/error.h"
#include "core/base/file_text.h"
#include "core/base/whole_file.h"

namespace haptrial::experiments {
namespace fs = std::filesystem;
namespace {

constexpr const char* kQuestion = "question.toml";
constexpr const char* kProgram = "program";
constexpr const char* kParts = "parts";

void check_same(const fs::path& folder, const PowerQuestion& question) {
  if (file_text(folder / kProgram) != program_words() + "\n") {
    std::string other = file_text(folder / kProgram);
    other.pop_back();
    throw InputError(fmt::format(
        "{}: was simulated by {}, and this is {}; choose a new folder, as their parts do not mix",
        folder.string(), other, program_words()));
  }
  if (file_text(folder / kQuestion) != question.text) {
    throw InputError(
        fmt::format("{}: holds parts of another definition; choose a new folder", folder.string()));
  }
}

/// Whether there is nothing but what a process leaves that was killed while it made the folder.
bool is_begun(const fs::path& folder) {
  for (const auto& entry : fs::directory_iterator(folder)) {
    const std::string name = entry.path().filename().string();
    const bool ours = name == kQuestion || (name == kParts && fs::is_empty(entry.path())) ||
                      name.find(".partial-") != std::string::npos;
    if (!ours) {
      return false;
    }
  }
  return true;
}

void add(const SimulatedStudy& study, const PowerQuestion& question, analysis::CellCounts& counts) {
  ++counts.replications;
  counts.trials += study.trials;
  bool watched = false;
  for (const NamedNumber& test : study.tests) {
    analysis::TestCount& count = counts.tests[test.name];
    ++count.made;
    count.rejected += test.value < question.plan.alpha ? 1U : 0U;
    watched = watched || test.name == question.plan.watch;
  }
  for (const NamedNumber& value : study.values) {
    counts.values[value.name].add(value.value);
  }
  if (study.trials > 0) {
    counts.hours.add(study.hours);
  }
  for (const std::string& reason : study.failures) {
    ++counts.reasons[reason];
  }
  if (!watched) {
    ++counts.reasons["the watched test could not be made"];
  }
}

}  // namespace

PowerFolder::PowerFolder(fs::path folder, const PowerQuestion& question)
    : folder_(std::move(folder)), question_(question), units_(units_of(question)) {
  std::error_code error;
  if (fs::exists(folder_ / kProgram, error)) {
    check_same(folder_, question_);
    return;
  }
  if (fs::exists(folder_, error) && (!fs::is_directory(folder_, error) || !is_begun(folder_))) {
    if (fs::exists(folder_ / kProgram, error)) {  // by now: another process made it
      check_same(folder_, question_);
      return;
    }
    throw InputError(
        fmt::format("{}: holds something else; choose a new folder with --out", folder_.string()));
  }
  fs::create_directories(folder_ / kParts, error);
  if (error) {
    throw InputError(fmt::format("{}: cannot be made: {}; choose a folder with write permission",
                                 folder_.string(), error.message()));
  }
  write_whole(folder_ / kQuestion, question_.text);
  write_whole(folder_ / kProgram, program_words() + "\n");  // the last: now the folder is whole
}

bool PowerFolder::has(const PowerUnit& unit) const {
  std::error_code error;
  return fs::exists(folder_ / kParts / unit.file(), error);
}

void PowerFolder::keep(const PowerUnit& unit,
                       const std::vector<SimulatedStudy>& replications) const {
  write_whole(folder_ / kParts / unit.file(), part_text(question_, unit, replications));
}

std::vector<PowerUnit> PowerFolder::missing() const {
  std::set<std::string> there;  // one look at the folder, which may be far away
  for (const auto& entry : fs::directory_iterator(folder_ / kParts)) {
    there.insert(entry.path().filename().string());
  }
  std::vector<PowerUnit> missing;
  for (const PowerUnit& unit : units_) {
    if (!there.contains(unit.file())) {
      missing.push_back(unit);
    }
  }
  return missing;
}

analysis::PowerResult PowerFolder::merged() const {
  if (const auto left = missing(); !left.empty()) {
    throw InputError(fmt::format("{}: {} of {} parts are missing; simulate again to make them",
                                 folder_.string(), left.size(), units_.size()));
  }
  analysis::PowerResult result;
  const PowerPlan& plan = question_.plan;
  result.title = question_.title;
  result.watch = plan.watch;
  result.alpha = plan.alpha;
  result.target = plan.target;
  result.in_full = plan.depth == PowerDepth::kSessions;
  result.seed = plan.seed;
  result.program = program_words();
  result.question = question_.text;
  for (const VariedKey& key : plan.vary) {
    result.keys.push_back({key.key, key.none});
  }
  std::vector<analysis::PowerCell> cells(question_.cells.size());
  for (const PowerUnit& unit : units_) {
    analysis::PowerCell& cell = cells[unit.cell];
    cell.levels = question_.cells[unit.cell].levels;
    const bool check = unit.sessions && !result.in_full;
    analysis::CellCounts& counts = !check          ? cell.counts
                                   : cell.sessions ? *cell.sessions
                                                   : cell.sessions.emplace();
    for (const SimulatedStudy& study : read_part(folder_ / kParts / unit.file(), question_, unit)) {
      add(study, question_, counts);
    }
  }
  for (std::size_t i = 0; i < cells.size(); ++i) {
    (question_.cells[i].null ? result.nulls : result.cells).push_back(std::move(cells[i]));
  }
  for (const fs::path& each : {folder_, folder_ / kParts}) {
    for (const auto& entry : fs::directory_iterator(each)) {
      if (entry.path().filename().string().find(".partial-") != std::string::npos) {
        std::error_code ignored;
        fs::remove(entry.path(), ignored);
      }
    }
  }
  return result;
}

PowerQuestion PowerFolder::question_of(const fs::path& folder) {
  std::error_code error;
  if (!fs::exists(folder / kProgram, error)) {
    throw InputError(
        fmt::format("{}: is no folder of a simulation of power; give one that haptrial "
                    "power simulate made",
                    folder.string()));
  }
  PowerQuestion question =
      parse_question({{file_text(folder / kQuestion), (folder / kQuestion).string()}}, folder);
  check_same(folder, question);
  return question;
}

}  // namespace haptrial::experiments
