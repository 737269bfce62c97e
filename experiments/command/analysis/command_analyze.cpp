#include "experiments/command/commands.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "analysis/exchange/import_curves.h"
#include "analysis/score_parameters.h"
#include "analysis/study.h"
#include "analysis/study_summary.h"
#include "analysis/write_analysis.h"
#include "core/base/error.h"
#include "experiments/command/arguments.h"
#include "experiments/control/interrupt.h"
#include "experiments/studies/experiment.h"
#include "experiments/studies/registry.h"
#include "experiments/study/study_files.h"

namespace haptrial::experiments {
namespace fs = std::filesystem;
namespace {

analysis::StudyResult analyzed_curves(const AnalyzeOptions& options, int threads) {
  watch_for_interrupt();
  CurveAnalysis curves;
  if (!options.definition.empty()) {
    load_experiment(options.definition);  // all of it is good, or nothing is taken of it
    curves = load_curve_analysis(options.definition);
  }
  std::vector<std::string> remarks;
  const analysis::AnalysisPlan plan =
      plan_for(options.planned, options.reference, curves.plan, remarks);
  analysis::StudyResult study = exchange::analyze_curves(
      {options.curves, options.table.empty() ? options.conditions : options.table,
       exchange::ImportColumns(options.columns), options.factors, plan},
      curves.scoring, threads, [](std::uint64_t) {
        if (interrupted()) {
          throw RunError("interrupted; nothing was written");
        }
      });
  analysis::check_plan(study.statistics.table, plan_of(options.planned, options.reference));
  study.remarks.insert(study.remarks.end(), remarks.begin(), remarks.end());
  return study;
}

/// Where the report of a folder of sessions goes: that of its pilots must not replace the study's.
fs::path report_folder(const fs::path& folder, Pilots pilots) {
  return pilots == Pilots::kAlone ? folder / "pilots" : folder;
}

void print_report(const std::vector<std::string>& lines, const fs::path& out) {
  for (const std::string& line : lines) {
    fmt::print("{}\n", line);
  }
  fmt::print("report: {}\n", (fs::absolute(out) / "report.html").lexically_normal().string());
}

int analyze_sessions(const AnalyzeOptions& options, Pilots pilots, int threads) {
  AnalysisRequest request;
  request.folder = options.folder;
  request.files = study_files(options.folder, pilots);
  request.out = report_folder(options.folder, pilots);
  request.pilots = pilots;
  request.threads = threads;
  request.planned = options.planned;
  request.reference = options.reference;
  print_report(study_of(request.files.first).analyze(request), request.out);
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
  if (!import) {
    return analyze_sessions(options, pilots, threads);
  }
  const analysis::StudyResult study = analyzed_curves(options, threads);
  analysis::write_analysis(study, options.out);
  std::vector<std::string> lines = analysis::summary_lines(study);
  lines.insert(lines.end(), study.remarks.begin(), study.remarks.end());
  lines.insert(lines.end(), study.alarms.begin(), study.alarms.end());
  print_report(lines, options.out);
  return 0;
}

}  // namespace haptrial::experiments
