#include "experiments/command/curves/curve_commands.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <optional>

#include "analysis/force_training/exchange/export_curves.h"
#include "analysis/force_training/exchange/import_curves.h"
#include "analysis/force_training/report/write_analysis.h"
#include "analysis/force_training/study/study.h"
#include "analysis/force_training/study/study_result.h"
#include "analysis/statistics/design/wording.h"
#include "core/base/error.h"
#include "core/record/read/session_reader.h"
#include "experiments/control/signals.h"
#include "experiments/studies/experiment.h"
#include "experiments/studies/registry.h"
#include "experiments/study/study_definitions.h"
#include "experiments/study/study_files.h"

namespace haptrial::experiments {

namespace fs = std::filesystem;
namespace {

using analysis::counted;

analysis::StudyResult analyzed_curves(const CurveOptions& options, int threads) {
  watch_for_interrupt();
  CurveAnalysis curves;
  if (!options.definition.empty()) {
    curves = curve_analysis_of(*load_experiment(options.definition).definition);
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

/// Curves do not say that they are of a pilot, so pilots must not stand among those of the study.
std::vector<fs::path> without_pilots(const std::vector<fs::path>& files) {
  std::vector<fs::path> study;
  std::vector<std::string> pilots;
  for (const fs::path& file : files) {
    if (record::SessionReader(file).info().pilot) {
      pilots.push_back(file.filename().string());
    } else {
      study.push_back(file);
    }
  }
  if (pilots.empty()) {
    return files;
  }
  if (study.empty()) {
    fmt::print("These are pilot sessions, not the study.\n");
    return files;
  }
  fmt::print("Not exported, because the session was a pilot: {}.\n", fmt::join(pilots, ", "));
  return study;
}

/// How the curves of sessions are scored. @throws InputError for one whose passes have none
CurveAnalysis analysis_of_curves(const std::vector<fs::path>& files) {
  std::optional<CurveAnalysis> first;
  for (const fs::path& file : files) {
    const record::SessionReader reader(file);
    const auto curves = study_of(reader.info()).curves(reader.info());
    if (!curves) {
      throw InputError(fmt::format(
          "{}: is a session of {}, which has no target force; --curves exports sessions whose "
          "passes have one",
          file.string(), study_of(reader.info()).protocol().name()));
    }
    first = first ? first : curves;
  }
  return *first;
}

}  // namespace

std::vector<std::string> analyze_curves(const CurveOptions& options, int paper, int threads) {
  const analysis::StudyResult study = analyzed_curves(options, threads);
  analysis::write_analysis(study, options.out, paper);
  std::vector<std::string> lines = analysis::summary_lines(study);
  lines.insert(lines.end(), study.remarks.begin(), study.remarks.end());
  lines.insert(lines.end(), study.alarms.begin(), study.alarms.end());
  return lines;
}

void export_curves(const std::string& folder, const std::vector<fs::path>& given, int jobs) {
  const CurveAnalysis analysis = analysis_of_curves(given);
  const std::vector<fs::path> files = without_pilots(given);
  ExportWatch watch(files);
  // One definition says how all of them are scored.
  definition_remarks(protocol_of(record::SessionReader(files.front()).info()), files);
  const auto done = exchange::export_curves(files, folder, analysis.scoring, jobs,
                                            [&](std::uint64_t samples) { watch(samples); });
  fmt::print("{} of {}\ncurves: {}\n", counted(done.trials, "scored trial"),
             counted(done.subjects, "participant"), folder);
}

ExportWatch::ExportWatch(const std::vector<std::filesystem::path>& files)
    : sessions_(exchange::sessions_to_export(files)),
      progress_("export", static_cast<double>(exchange::total_samples(sessions_))) {}

void ExportWatch::operator()(std::uint64_t samples) {
  if (interrupted()) {
    throw RunError("interrupted; nothing was exported");
  }
  progress_.update(static_cast<double>(samples),
                   fmt::format("{:.1f} million samples", 1e-6 * static_cast<double>(samples)),
                   sessions_.front().info.rate);
}

}  // namespace haptrial::experiments
