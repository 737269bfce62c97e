#include "experiments/commands.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "analysis/score_parameters.h"
#include "analysis/study.h"
#include "analysis/write_analysis.h"
#include "core/base/error.h"
#include "core/record/session_reader.h"
#include "experiments/arguments.h"
#include "experiments/definition.h"
#include "experiments/study_run.h"

namespace haptrial::experiments {
namespace fs = std::filesystem;
namespace {

/// Sentences about sessions that the study planned and the folder lacks.
std::vector<std::string> what_is_missing(const fs::path& folder, std::size_t sessions,
                                         const Definition& definition) {
  std::vector<std::string> remarks;
  const auto planned = static_cast<std::size_t>(definition.design.participants);
  if (sessions != planned) {
    remarks.push_back(fmt::format("{} of {} planned participants are here.", sessions, planned));
  }
  std::vector<std::string> unfinished;
  for (const auto& entry : fs::directory_iterator(folder)) {
    if (entry.path().extension() == ".partial") {
      unfinished.push_back(entry.path().filename().string());
    }
  }
  std::sort(unfinished.begin(), unfinished.end());
  if (!unfinished.empty()) {
    remarks.push_back(fmt::format("Not analysed, because the session did not come to its end: {}.",
                                  fmt::join(unfinished, ", ")));
  }
  return remarks;
}

}  // namespace

int analyze(const std::string& folder, std::optional<int> jobs) {
  const int threads = checked_jobs(jobs);
  const auto files = session_files(folder);
  const record::SessionInfo first = record::SessionReader(files.front()).info();
  for (const fs::path& file : files) {
    if (record::SessionReader(file).info().definition != first.definition) {
      throw InputError(
          fmt::format("{}: was recorded with another definition than {}; analyse each "
                      "study in a folder of its own",
                      file.string(), files.front().string()));
    }
  }
  const Definition definition = parse_definition(first.definition, first.definition_name);
  analysis::StudyResult study = analysis::analyze_study(files, definition.scoring, threads);
  if (study.scores.empty()) {
    throw InputError(fmt::format(
        "{}: no session holds a completed test pass, so nothing can be scored", folder));
  }
  study.remarks = what_is_missing(folder, files.size(), definition);
  analysis::write_analysis(study, folder);
  for (const std::string& line : analysis::summary_lines(study)) {
    fmt::print("{}\n", line);
  }
  for (const std::string& remark : study.remarks) {
    fmt::print("{}\n", remark);
  }
  fmt::print("report: {}\n", (fs::absolute(folder) / "report.html").lexically_normal().string());
  return 0;
}

}  // namespace haptrial::experiments
