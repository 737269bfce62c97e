#include "analysis/bone_drilling/report/validity_summary.h"

#include <fmt/format.h>

#include <utility>

#include "analysis/bone_drilling/report/nerve_section.h"
#include "analysis/bone_drilling/report/validity_figures.h"
#include "analysis/bone_drilling/report/validity_words.h"
#include "analysis/document/number.h"
#include "analysis/statistics/design/wording.h"

namespace haptrial::analysis::drilling {
namespace {

constexpr double kAlpha = 0.05;

/// "3.438, 95 % CI 3.290 to 3.585 (8 participants, 16 procedures)".
std::string mean_of(const GroupValues& group) {
  const auto& means = group.participant_means;
  return fmt::format(
      "{} ({}, {})",
      !means && group.mean
          ? fmt::format("{} without an interval, because {}", number(*group.mean), means.because())
          : mean_with_interval(means),
      counted(group.participants, "participant"), counted(group.procedures, "procedure"));
}

std::vector<std::string> rating_lines(const Validity& v) {
  const auto& groups = v.rating_groups;
  const Contrast& c = v.rating_contrast;
  std::vector<std::string> lines{
      fmt::format("mean rating, participants as the unit: with experience {}; novices {}",
                  mean_of(*(groups.end() - 2)), mean_of(groups.back()))};
  lines.push_back(c.means ? fmt::format("experts rated higher than novices: {}; {} (Welch's test "
                                        "of participants' means, one-tailed)",
                                        c.means->p < kAlpha ? "significant" : "not significant",
                                        welch_word(c))
                          : "experts rated higher than novices: " + welch_word(c));
  return lines;
}

std::string contrast_line(const Validity& v) {
  std::vector<std::string> found;
  for (const MetricValidity& m : v.metrics) {
    if (m.contrast_holm && *m.contrast_holm < kAlpha) {
      found.push_back(fmt::format("{} ({})", m.kind.title, p_value(*m.contrast_holm)));
    }
  }
  return fmt::format(
      "metrics that differ between experts and novices, p after Holm's adjustment "
      "over {}: {}",
      counted(contrasts_of(v), "metric"),
      found.empty() ? "none" : fmt::format("{}", fmt::join(found, "; ")));
}

std::vector<std::string> relation_lines(const Validity& v) {
  std::vector<std::string> lines;
  for (const char* name : {"visible_share", kRegionMetric}) {
    const MetricValidity* m = metric_of(v, name);
    if (m != nullptr && m->relation_holm) {
      lines.push_back(fmt::format("{} and ratings: R = {}, over the means of {}", m->kind.title,
                                  relation_word(v, *m),
                                  counted(m->relation.means->count, "participant")));
    }
  }
  return lines;
}

}  // namespace

std::vector<std::string> summary_lines(const ValidityResult& result) {
  const Validity& v = result.validity;
  std::vector<std::string> lines;
  if (v.rated == 0) {
    lines.push_back(counted(result.procedures.size(), "procedure") + ", not rated yet");
  } else {
    lines = rating_lines(v);
    if (std::string uneven = uneven_raters(v); !uneven.empty()) {
      lines.push_back(std::move(uneven));
    }
  }
  for (std::string& line : learning_lines(result.learned)) {
    lines.push_back(std::move(line));
  }
  if (contrasts_of(v) > 0) {
    lines.push_back(contrast_line(v));
  }
  for (std::string& line : relation_lines(v)) {
    lines.push_back(std::move(line));
  }
  for (std::string& line : nerve_lines(result.nerves)) {
    lines.push_back(std::move(line));
  }
  for (std::string& line : hint_lines(result.hints, result.hint_effects)) {
    lines.push_back(std::move(line));
  }
  for (std::string& line : crossing_lines(result.crossings)) {
    lines.push_back(std::move(line));
  }
  if (const auto& fit = v.combined.fit; fit && fit->validated.r) {
    lines.push_back(
        fmt::format("all metrics together predict the ratings of participants left out with R = "
                    "{:.2f}; squared error {}",
                    *fit->validated.r, error_word(*fit)));
  }
  for (std::string& line : lines) {
    line = (v.simulated ? "Simulated: " + line : capitalized(line)) + ".";
  }
  if (v.simulated) {
    lines.emplace_back(
        "A rehearsal of the pipeline with programs: it proves nothing about people.");
  }
  return lines;
}

}  // namespace haptrial::analysis::drilling
