#include "experiments/study/study_files.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/base/error.h"
#include "core/record/read/session_reader.h"
#include "experiments/study/study_definitions.h"
#include "experiments/study/study_run.h"

namespace haptrial::experiments {
namespace {

namespace fs = std::filesystem;

struct Sorted {
  std::vector<fs::path> study;
  std::vector<fs::path> pilots;
};

Sorted sorted_files(const fs::path& folder) {
  Sorted sorted;
  for (const fs::path& file : session_files(folder)) {
    (record::SessionReader(file).info().pilot ? sorted.pilots : sorted.study).push_back(file);
  }
  return sorted;
}

std::vector<fs::path> taken(const Sorted& sorted, const fs::path& folder, Pilots pilots) {
  const bool alone = pilots == Pilots::kAlone;
  const auto& files = alone ? sorted.pilots : sorted.study;
  if (files.empty()) {
    throw InputError(fmt::format("{}: holds {}", folder.string(),
                                 alone
                                     ? "no pilot sessions; leave --pilots out to analyse the study"
                                     : "only pilot sessions; analyse them with --pilots"));
  }
  return files;
}

std::string names_of(const std::vector<fs::path>& files) {
  std::string names;
  for (const fs::path& file : files) {
    names += (names.empty() ? "" : ", ") + file.filename().string();
  }
  return names;
}

std::string remark_on_pilots(const Sorted& sorted, Pilots pilots) {
  if (pilots == Pilots::kAlone) {
    return "These are pilot sessions, not the study.";
  }
  return sorted.pilots.empty() ? ""
                               : fmt::format("Not analysed, because the session was a pilot: {}.",
                                             names_of(sorted.pilots));
}

}  // namespace

std::vector<std::string> unfinished_sessions(const fs::path& folder) {
  std::vector<std::string> names;
  std::error_code ignored;
  for (const auto& entry : fs::directory_iterator(folder, ignored)) {
    if (entry.path().extension() == ".partial") {
      names.push_back(entry.path().filename().string());
    }
  }
  std::sort(names.begin(), names.end());
  return names;
}

bool holds_sessions(const fs::path& folder) {
  std::error_code ignored;
  const fs::directory_iterator files(folder, ignored);
  return std::any_of(begin(files), end(files), [](const fs::directory_entry& entry) {
    return entry.path().extension() == ".h5" || entry.path().extension() == ".partial";
  });
}

std::vector<fs::path> files_of(const fs::path& folder, Pilots pilots) {
  return taken(sorted_files(folder), folder, pilots);
}

StudyFiles study_files(const fs::path& folder, Pilots pilots) {
  const Sorted sorted = sorted_files(folder);
  StudyFiles study;
  study.files = taken(sorted, folder, pilots);
  study.first = record::SessionReader(study.files.front()).info();
  if (const std::string remark = remark_on_pilots(sorted, pilots); !remark.empty()) {
    study.remarks.push_back(remark);
  }
  const std::vector<std::string> changed = definition_remarks(study.files);
  study.remarks.insert(study.remarks.end(), changed.begin(), changed.end());
  return study;
}

}  // namespace haptrial::experiments
