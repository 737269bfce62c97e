#include "experiments/commands.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

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
    remarks.push_back(fmt::format("{} of {} planned participants {} a session in this folder.",
                                  sessions, planned, sessions == 1 ? "has" : "have"));
  }
  if (const auto unfinished = unfinished_sessions(folder); !unfinished.empty()) {
    remarks.push_back(fmt::format("Not analysed, because the session is unfinished: {}.",
                                  fmt::join(unfinished, ", ")));
  }
  return remarks;
}

/// The definition's plan, unless options say another: then `remark` says so.
analysis::AnalysisPlan plan_for(const AnalyzeOptions& options, analysis::AnalysisPlan plan,
                                std::vector<std::string>& remarks) {
  const analysis::AnalysisPlan given = plan_of(options.planned, options.reference);
  if (!given.tests.empty()) {
    plan.tests = given.tests;
    remarks.emplace_back("The planned tests were given to analyze, not stated in the definition.");
  }
  if (!given.reference.empty()) {
    plan.reference = given.reference;
    remarks.emplace_back(
        "The reference condition was given to analyze, not stated in the definition.");
  }
  return plan;
}

analysis::StudyResult analyzed_sessions(const AnalyzeOptions& options, Pilots pilots, int threads) {
  const std::string& folder = options.folder;
  const StudyFiles found = study_files(folder, pilots);
  const Definition definition =
      parse_definition(found.first.definition, found.first.definition_name);
  std::vector<std::string> remarks;
  const analysis::AnalysisPlan plan = plan_for(options, definition.plan, remarks);
  analysis::StudyResult study =
      analysis::analyze_study(found.files, definition.scoring, threads, plan);
  if (study.scores.empty()) {
    throw InputError(fmt::format(
        "{}: no session holds a completed test pass, so nothing can be scored", folder));
  }
  analysis::check_plan(study.statistics.table, plan_of(options.planned, options.reference));
  study.remarks = found.remarks;
  study.remarks.insert(study.remarks.end(), remarks.begin(), remarks.end());
  if (pilots == Pilots::kLeftOut) {
    for (std::string& remark : what_is_missing(folder, found.files.size(), definition)) {
      study.remarks.push_back(std::move(remark));
    }
  }
  return study;
}

analysis::StudyResult analyzed_curves(const AnalyzeOptions& options, int threads) {
  watch_for_interrupt();
  analysis::ScoreParameters scoring;
  analysis::AnalysisPlan plan;
  if (!options.definition.empty()) {
    const Definition definition = load_definition(options.definition);
    scoring = definition.scoring;
    plan = definition.plan;
  }
  std::vector<std::string> remarks;
  plan = plan_for(options, std::move(plan), remarks);
  analysis::StudyResult study = exchange::analyze_curves(
      {options.curves, options.table.empty() ? options.conditions : options.table,
       exchange::ImportColumns(options.columns), options.factors, plan},
      scoring, threads, [](std::uint64_t) {
        if (interrupted()) {
          throw RunError("interrupted; nothing was written");
        }
      });
  analysis::check_plan(study.statistics.table, plan_of(options.planned, options.reference));
  study.remarks.insert(study.remarks.end(), remarks.begin(), remarks.end());
  return study;
}

bool holds_drillings(const std::string& folder, Pilots pilots) {
  return record::SessionReader(files_of(folder, pilots).front()).drills();
}

/// Where the report of a folder of sessions goes: that of its pilots must not replace the study's.
fs::path report_folder(const fs::path& folder, Pilots pilots) {
  return pilots == Pilots::kAlone ? folder / "pilots" : folder;
}

int analyze_procedures(const std::string& folder, Pilots pilots, int threads) {
  const StudyFiles study = study_files(folder, pilots);
  const fs::path out = report_folder(folder, pilots);
  for (const std::string& line : analyze_drillings(folder, study, out, threads)) {
    fmt::print("{}\n", line);
  }
  fmt::print("report: {}\n", (fs::absolute(out) / "report.html").lexically_normal().string());
  return 0;
}

bool is_import(const AnalyzeOptions& options) { return options.folder.empty(); }

void require_one_source(const AnalyzeOptions& options) {
  const int sources = !options.folder.empty() + !options.curves.empty() + !options.table.empty();
  if (sources != 1) {
    throw InputError("give exactly one of DIR, --curves and --table");
  }
}

/// Options that the source needs and that only others take.
void check_source(const AnalyzeOptions& options) {
  require_one_source(options);
  const bool curves = !options.curves.empty();
  const bool table = !options.table.empty();
  const auto need = [](const char* name, const std::string& value, const char* by) {
    if (value.empty()) {
      throw InputError(fmt::format("{} is missing; {} needs it", name, by));
    }
  };
  const auto allow = [](bool allowed, const char* name, bool given, const char* with) {
    if (!allowed && given) {
      throw InputError(fmt::format("{} is given without {}; leave it out", name, with));
    }
  };
  if (curves) {
    need("--conditions", options.conditions, "--curves");
  }
  if (curves || table) {
    need("--out", options.out, curves ? "--curves" : "--table");
  }
  allow(curves, "--conditions", !options.conditions.empty(), "--curves");
  constexpr const char* kImport = "--curves or --table";
  allow(is_import(options), "--out", !options.out.empty(), kImport);
  allow(is_import(options), "--definition", !options.definition.empty(), kImport);
  allow(is_import(options), "--column", !options.columns.empty(), kImport);
  allow(is_import(options), "--factor", !options.factors.empty(), kImport);
  allow(!is_import(options), "--pilots", options.pilots, "a folder of sessions");
  if (is_import(options) && holds_sessions(options.out)) {  // whose report this would replace
    throw InputError(
        fmt::format("{}: --out holds session files; choose another folder", options.out));
  }
}

}  // namespace

int analyze(const AnalyzeOptions& options) {
  const int threads = checked_jobs(options.jobs);
  check_source(options);
  const bool import = is_import(options);
  const Pilots pilots = options.pilots ? Pilots::kAlone : Pilots::kLeftOut;
  if (!import && holds_drillings(options.folder, pilots)) {
    return analyze_procedures(options.folder, pilots, threads);
  }
  const analysis::StudyResult study =
      import ? analyzed_curves(options, threads) : analyzed_sessions(options, pilots, threads);
  const fs::path out = import ? fs::path(options.out) : report_folder(options.folder, pilots);
  analysis::write_analysis(study, out);
  for (const std::string& line : analysis::summary_lines(study)) {
    fmt::print("{}\n", line);
  }
  for (const std::string& remark : study.remarks) {
    fmt::print("{}\n", remark);
  }
  for (const std::string& alarm : study.alarms) {
    fmt::print("{}\n", alarm);
  }
  fmt::print("report: {}\n", (fs::absolute(out) / "report.html").lexically_normal().string());
  return 0;
}

}  // namespace haptrial::experiments
