#include "analysis/scores_csv.h"

#include <fmt/format.h>

namespace haptrial::analysis {
namespace {

std::string field(const std::string& text) {
  if (text.find_first_of(",\"\r\n") == std::string::npos) {
    return text;
  }
  std::string result = "\"";
  for (const char c : text) {
    result += c;
    if (c == '"') {
      result += '"';
    }
  }
  return result + "\"";
}

}  // namespace

std::string scores_csv(std::span<const TrialScore> scores) {
  std::string text =
      "subject,trial,block,repetition,condition,score,alignment_cost,rms_force,rms_slope,"
      "rms_unaligned\n";
  for (const auto& s : scores) {
    text += fmt::format("{},{},{},{},{},{},{},{},{},{}\n", field(s.subject), s.trial, s.block,
                        s.repetition, field(s.condition), s.score, s.alignment_cost, s.rms_force,
                        s.rms_slope, s.rms_unaligned);
  }
  return text;
}

}  // namespace haptrial::analysis
