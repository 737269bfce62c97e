#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <filesystem>
#include <iterator>
#include <optional>

#include "analysis/force_training/report/comparison.h"
#include "core/base/error.h"
#include "core/record/read/session_reader.h"
#include "experiments/command/subcommand.h"
#include "experiments/studies/registry.h"
#include "experiments/study/study_files.h"
#include "protocols/interface/study_rules.h"

namespace haptrial::experiments {
namespace fs = std::filesystem;
namespace {

struct CompareOptions {
  std::string first;
  std::string second;
  std::string out;
  bool different_scoring{false};
};

/// A session of the study in a folder; nothing without one that can be read.
std::optional<record::SessionInfo> session_in(const fs::path& folder) {
  try {
    return record::SessionReader(files_of(folder, Pilots::kLeftOut).front()).info();
  } catch (const InputError&) {
    return std::nullopt;
  }
}

/// Keys in which the studies' definitions differ; empty if none does, or if a folder does not hold
/// its study's sessions.
std::vector<std::string> remarks_on_definitions(const fs::path& first, const fs::path& second) {
  const auto one = session_in(first);
  const auto other = session_in(second);
  const DefinitionChanges changes = one && other
                                        ? protocols::study_changes(protocol_of(*one), *one, *other)
                                        : DefinitionChanges{};
  if (!changes.same_study()) {
    return {fmt::format("The definitions differ in what was presented, recorded or scored: {}.",
                        sentence_of(changes.binding))};
  }
  if (changes.free.empty()) {
    return {};
  }
  return {fmt::format("The definitions differ only in keys that may change within a study: {}.",
                      sentence_of(changes.free))};
}

int compare(const CompareOptions& options) {
  analysis::StudyComparison comparison = analysis::compare_studies(
      analysis::read_scored_study(options.first), analysis::read_scored_study(options.second),
      options.different_scoring ? analysis::Scoring::kMayDiffer : analysis::Scoring::kSame);
  std::ranges::move(remarks_on_definitions(options.first, options.second),
                    std::back_inserter(comparison.remarks));
  const std::string& out = options.out;
  for (const std::string& alarm : analysis::comparison_alarms(comparison)) {
    fmt::print("{}\n", alarm);
  }
  for (const std::string& line : analysis::comparison_lines(comparison)) {
    fmt::print("{}\n", line);
  }
  if (!out.empty()) {
    std::error_code error;
    fs::create_directories(out, error);
    if (!fs::is_directory(out)) {
      throw InputError(fmt::format("{}: is not a folder and cannot become one", out));
    }
    analysis::write_comparison(comparison, out);
    fmt::print("comparison: {}\n", (fs::path(out) / "comparison.html").string());
  }
  return 0;
}

}  // namespace

void add_compare(CLI::App& app, int& status) {
  CLI::App* sub = subcommand(
      app, "compare", "Compare the scores of two analysed studies",
      "haptrial compare results/force_training results/force_training_curve --out out/compared",
      {"a report, a figure and the numbers in the folder of --out", "guide-analyst.md"});
  auto& o = options_of<CompareOptions>(*sub, status, compare);
  sub->add_option("FIRST", o.first, "Folder of the first analysed study")->required();
  sub->add_option("SECOND", o.second, "Folder of the second analysed study")->required();
  sub->add_option("--out", o.out, "Folder for the comparison: a report, a figure and the numbers");
  sub->add_flag("--different-scoring", o.different_scoring,
                "Compare scores made with different parameters, with a warning on top");
}

}  // namespace haptrial::experiments
