#include "analysis/bone_drilling/report/validity_words.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "analysis/bone_drilling/report/nerve_section.h"
#include "analysis/bone_drilling/report/validity_figures.h"
#include "analysis/document/number.h"
#include "analysis/statistics/design/wording.h"

namespace haptrial::analysis::drilling {
namespace {

std::string difference_word(double difference, double low, double high, double df, double t,
                            double p) {
  return fmt::format("difference {}, 95 % CI {} to {}, t({:.1f}) = {:.2f}, {}", number(difference),
                     number(low), number(high), df, t, p_value(p));
}

}  // namespace

std::string undefined(const std::string& because) { return "not defined, because " + because; }

std::string mean_word(const GroupValues& group) {
  return !group.participant_means && group.mean ? number(*group.mean)
                                                : interval_word(group.participant_means);
}

std::string word(const Defined<double>& p) { return p ? p_value(*p) : "–"; }

std::string correlation_word(const Defined<Correlation>& c) {
  return c ? fmt::format("{:.2f}, {}", c->r, p_value(c->p)) : "–";
}

std::string relation_word(const Validity& v, const MetricValidity& metric) {
  const auto& means = metric.relation.means;
  return means && metric.relation_holm
             ? fmt::format("{:.2f} ({} after Holm's adjustment over {})", means->r,
                           p_value(*metric.relation_holm), counted(relations_of(v), "metric"))
             : "–";
}

std::string area_word(const Defined<Roc>& roc) {
  if (!roc) {
    return "–";
  }
  return roc->interval ? fmt::format("{:.2f} [{:.2f}, {:.2f}]", roc->area, roc->interval->low,
                                     roc->interval->high)
                       : fmt::format("{:.2f}", roc->area);
}

std::string form_word(const Defined<IntraclassForm>& form, bool apart) {
  if (!form) {
    return undefined(form.because());
  }
  const std::string value = fmt::format("{:.2f}", form->value);
  return apart ? fmt::format("{}, 95 % CI {:.2f} to {:.2f}, F({:.0f}, {:.0f}) = {}, {}", value,
                             form->low, form->high, form->df_targets, form->df_error,
                             number(form->f), p_value(form->p))
               : value;
}

std::string welch_word(const Contrast& c) {
  return c.means ? difference_word(c.means->difference, c.means->low, c.means->high, c.means->df,
                                   c.means->t, c.means->p)
                 : undefined(c.means.because());
}

std::string mixed_word(const Contrast& c) {
  if (!c.mixed) {
    return undefined(c.mixed.because());
  }
  const Coefficient& b = c.mixed->coefficients[1];
  return difference_word(b.estimate, b.low, b.high, b.df, b.t, *c.mixed_p) +
         (c.mixed->at_boundary ? " (no variance between participants)" : "");
}

std::string error_word(const CrossValidated& fit) {
  return fmt::format("{:.0f} % {} than that of the other participants' mean rating",
                     100.0 * std::abs(fit.gain), fit.gain < 0.0 ? "higher" : "lower");
}

std::string name_of(const MetricKind& kind) {
  return kind.unit == "1" ? kind.title : fmt::format("{} ({})", kind.title, kind.unit);
}

std::vector<const GroupValues*> shown_groups(const Validity& v) {
  const auto experts = v.plan.expert_groups.size();
  std::vector<const GroupValues*> shown;
  for (std::size_t g = 0; g < v.plan.groups.size(); ++g) {
    shown.push_back(&v.rating_groups[g]);
  }
  if (experts > 1) {
    shown.push_back(&*(v.rating_groups.end() - 2));
  }
  if (v.plan.groups.size() - experts > 1) {
    shown.push_back(&v.rating_groups.back());
  }
  return shown;
}

std::size_t contrasts_of(const Validity& v) {
  return static_cast<std::size_t>(
      std::count_if(v.metrics.begin(), v.metrics.end(),
                    [](const auto& m) { return static_cast<bool>(m.contrast_holm); }));
}

std::size_t relations_of(const Validity& v) {
  return static_cast<std::size_t>(
      std::count_if(v.metrics.begin(), v.metrics.end(),
                    [](const auto& m) { return static_cast<bool>(m.relation_holm); }));
}

namespace {

constexpr double kAlpha = 0.05;

/// "3.438, 95 % CI 3.290 to 3.585 (8 participants, 16 procedures)".
std::string mean_of(const GroupValues& group) {
  return fmt::format("{} ({}, {})", mean_with_interval(group.participant_means),
                     counted(group.participants, "participant"),
                     counted(group.procedures, "procedure"));
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
