#include "experiments/commands.h"

#include <fmt/format.h>

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
  const analysis::StudyResult study = analysis::analyze_study(files, definition.scoring, threads);
  analysis::write_analysis(study, folder);
  for (const std::string& line : analysis::summary_lines(study)) {
    fmt::print("{}\n", line);
  }
  fmt::print("report: {}\n", (fs::absolute(folder) / "report.html").lexically_normal().string());
  return 0;
}

}  // namespace haptrial::experiments
