#include <fmt/format.h>

#include <filesystem>

#include "analysis/comparison.h"
#include "core/base/error.h"
#include "experiments/command/commands.h"

namespace haptrial::experiments {
namespace fs = std::filesystem;

int compare(const CompareOptions& options) {
  const analysis::StudyComparison comparison = analysis::compare_studies(
      analysis::read_scored_study(options.first), analysis::read_scored_study(options.second),
      options.different_scoring ? analysis::Scoring::kMayDiffer : analysis::Scoring::kSame);
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

}  // namespace haptrial::experiments
