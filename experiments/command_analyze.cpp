#include "experiments/commands.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <tuple>

#include "analysis/exchange/import_curves.h"
#include "analysis/score_parameters.h"
#include "analysis/study.h"
#include "analysis/write_analysis.h"
#include "core/base/error.h"
#include "core/record/session_reader.h"
#include "experiments/arguments.h"
#include "experiments/definition.h"
#include "experiments/drilling_study.h"
#include "experiments/interrupt.h"
#include "experiments/study_files.h"

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

analysis::StudyResult analyzed_sessions(const std::string& folder, Pilots pilots, int threads) {
  const StudyFiles found = study_files(folder, pilots);
  const Definition definition =
      parse_definition(found.first.definition, found.first.definition_name);
  analysis::StudyResult study = analysis::analyze_study(found.files, definition.scoring, threads);
  if (study.scores.empty()) {
    throw InputError(fmt::format(
        "{}: no session holds a completed test pass, so nothing can be scored", folder));
  }
  study.remarks = found.remarks;
  if (pilots == Pilots::kLeftOut) {
    for (std::string& remark : what_is_missing(folder, found.files.size(), definition)) {
      study.remarks.push_back(std::move(remark));
    }
  }
  return study;
}

analysis::StudyResult analyzed_curves(const AnalyzeOptions& options, int threads) {
  watch_for_interrupt();
  const analysis::ScoreParameters scoring = options.definition.empty()
                                                ? analysis::ScoreParameters{}
                                                : load_definition(options.definition).scoring;
  return exchange::analyze_curves({options.curves, options.conditions, options.time_column,
                                   options.target_column, options.applied_column},
                                  scoring, threads, [](std::uint64_t) {
                                    if (interrupted()) {
                                      throw RunError("interrupted; nothing was written");
                                    }
                                  });
}

bool holds_drillings(const std::string& folder, Pilots pilots) {
  return record::SessionReader(files_of(folder, pilots).front()).drills();
}

int analyze_procedures(const std::string& folder, Pilots pilots, int threads) {
  const StudyFiles study = study_files(folder, pilots);
  for (const std::string& line : analyze_drillings(folder, study, threads)) {
    fmt::print("{}\n", line);
  }
  fmt::print("report: {}\n", (fs::absolute(folder) / "report.html").lexically_normal().string());
  return 0;
}

/// A folder of sessions, or one of curves with all that it needs.
void check_source(const AnalyzeOptions& options) {
  if (options.folder.empty() == options.curves.empty()) {
    throw InputError(fmt::format("{} of DIR and --curves are given; allowed: exactly one",
                                 options.folder.empty() ? "none" : "both"));
  }
  const bool curves = !options.curves.empty();
  for (const auto& [name, value, needed] : {std::tuple{"--conditions", &options.conditions, true},
                                            {"--out", &options.out, true},
                                            {"--definition", &options.definition, false},
                                            {"--time-column", &options.time_column, false},
                                            {"--target-column", &options.target_column, false},
                                            {"--applied-column", &options.applied_column, false}}) {
    if (curves && needed && value->empty()) {
      throw InputError(fmt::format("{} is missing; --curves needs it", name));
    }
    if (!curves && !value->empty()) {
      throw InputError(fmt::format("{} is given without --curves; allowed: only with it", name));
    }
  }
  if (curves && options.pilots) {
    throw InputError("--pilots is given with --curves; allowed: only with a folder of sessions");
  }
}

}  // namespace

int analyze(const AnalyzeOptions& options) {
  const int threads = checked_jobs(options.jobs);
  check_source(options);
  const bool curves = !options.curves.empty();
  const Pilots pilots = options.pilots ? Pilots::kAlone : Pilots::kLeftOut;
  if (!curves && holds_drillings(options.folder, pilots)) {
    return analyze_procedures(options.folder, pilots, threads);
  }
  const analysis::StudyResult study = curves ? analyzed_curves(options, threads)
                                             : analyzed_sessions(options.folder, pilots, threads);
  const fs::path out = curves ? options.out : options.folder;
  analysis::write_analysis(study, out);
  for (const std::string& line : analysis::summary_lines(study)) {
    fmt::print("{}\n", line);
  }
  for (const std::string& remark : study.remarks) {
    fmt::print("{}\n", remark);
  }
  fmt::print("report: {}\n", (fs::absolute(out) / "report.html").lexically_normal().string());
  return 0;
}

}  // namespace haptrial::experiments
