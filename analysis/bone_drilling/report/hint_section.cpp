#include "analysis/bone_drilling/report/hint_section.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <optional>
#include <utility>

#include "analysis/bone_drilling/metrics/procedure.h"
#include "analysis/bone_drilling/report/validity_words.h"
#include "analysis/statistics/base/p_adjust.h"
#include "core/bone/hint/hint_rows.h"
#include "core/record/read/session_reader.h"

namespace haptrial::analysis::drilling {
namespace {

using hint::HintKind;

bool holds_tick(const record::PassRow& pass, std::uint64_t tick) {
  return tick >= pass.first_sample && tick <= pass.last_sample;
}

void count(const std::vector<record::HintRow>& rows, const record::PassRow& pass, double rate,
           HintProcedure& p) {
  for (const record::HintRow& row : rows) {
    if (holds_tick(pass, row.begin)) {
      HintCounts& kind = p.kinds[static_cast<std::size_t>(row.kind)];
      ++kind.hints;
      kind.removals += row.removals;
      kind.time += static_cast<double>(row.sequence - row.begin) / rate;
    }
  }
}

}  // namespace

int HintProcedure::hints() const {
  int sum = 0;
  for (const HintCounts& kind : kinds) {
    sum += kind.hints;
  }
  return sum;
}

std::vector<HintProcedure> load_hints(const record::SessionReader& file,
                                      std::span<const ProcedureSummary> summaries) {
  if (!file.has(record::table_of<record::HintRow>())) {
    return {};
  }
  const auto rows = file.rows<record::HintRow>();
  const auto passes = counted_passes(file);
  std::vector<HintProcedure> procedures;
  for (const ProcedureSummary& summary : summaries) {
    const std::vector<CountedPass>& own = passes.at(summary.number);
    HintProcedure p{given_procedure(summary, own.back().pass.condition, hint::kHints), {}};
    for (const CountedPass& each : own) {
      count(rows, each.pass, file.info().rate, p);
    }
    procedures.push_back(std::move(p));
  }
  return procedures;
}

std::string hints_csv(std::span<const HintProcedure> procedures) {
  std::string text =
      "session,participant,group,procedure,simulated,condition,shown,drilling_s,kind,hints,"
      "removals,time_s\n";
  for (const HintProcedure& p : procedures) {
    for (const HintKind kind : hint::kAllHintKinds) {
      const HintCounts& counts = p.of(kind);
      text +=
          fmt::format("{},{},{},{},{},\"{}\",{},{:.3f},{},{},{},{:.3f}\n", p.session, p.participant,
                      p.group, p.number, p.simulated ? 1 : 0, p.condition, p.given ? 1 : 0,
                      p.drilling, hint::name_of(kind), counts.hints, counts.removals, counts.time);
    }
  }
  return text;
}

namespace {

using HintRowText = std::vector<std::string>;

/// Sum over the hints of some procedures of one condition.
struct HintSum {
  std::size_t procedures{0};
  double minutes{0.0};  // of drilling
  HintCounts counts;
};

std::vector<std::string> conditions_of(std::span<const HintProcedure> hints) {
  std::vector<std::string> conditions;
  for (const bool shown : {true, false}) {
    for (const HintProcedure& p : hints) {
      if (p.given == shown &&
          std::find(conditions.begin(), conditions.end(), p.condition) == conditions.end()) {
        conditions.push_back(p.condition);
      }
    }
  }
  return conditions;
}

HintSum sum_of(std::span<const HintProcedure> hints, const std::string& condition, HintKind kind) {
  HintSum sum;
  for (const HintProcedure& p : hints) {
    if (p.condition == condition) {
      ++sum.procedures;
      sum.minutes += p.drilling / 60.0;
      sum.counts.hints += p.of(kind).hints;
      sum.counts.removals += p.of(kind).removals;
      sum.counts.time += p.of(kind).time;
    }
  }
  return sum;
}

HintRowText row_of(const std::string& condition, HintKind kind, const HintSum& sum) {
  return {condition,
          std::string(hint::name_of(kind)),
          std::to_string(sum.procedures),
          fmt::format("{:.1f}", sum.minutes),
          std::to_string(sum.counts.hints),
          sum.minutes > 0.0 ? fmt::format("{:.2f}", sum.counts.hints / sum.minutes) : "–",
          std::to_string(sum.counts.removals),
          fmt::format("{:.1f}", sum.counts.time)};
}

/// Metric of the procedure's summary with the same session and number.
std::optional<double> metric_in(std::span<const ProcedureSummary> summaries, const HintProcedure& p,
                                const char* metric) {
  const auto at = std::find_if(summaries.begin(), summaries.end(), [&](const auto& summary) {
    return summary.session == p.session && summary.number == p.number;
  });
  return at != summaries.end() ? at->value(metric) : std::nullopt;
}

HintEffect effect_of(const MetricKind& kind, const std::vector<GivenValue>& values) {
  return {kind.name, kind.title, kind.unit, with_less_without(values)};
}

}  // namespace

std::vector<HintEffect> hint_effects(std::span<const HintProcedure> hints,
                                     std::span<const ProcedureSummary> summaries) {
  std::vector<GivenValue> rates;
  for (const HintProcedure& p : hints) {
    rates.push_back(
        {p.participant, p.given,
         p.drilling > 0.0 ? std::optional(60.0 * p.hints() / p.drilling) : std::nullopt});
  }
  if (!has_both(rates)) {
    return {};
  }
  std::vector<HintEffect> effects{
      effect_of({"hint_rate", "1/min", "hints a minute of drilling"}, rates)};
  for (const MetricKind& kind : metric_kinds()) {
    if (kind.name == "near_force" || kind.name == "near_speed" || kind.name == "visible_share") {
      std::vector<GivenValue> values;
      for (const HintProcedure& p : hints) {
        values.push_back({p.participant, p.given, metric_in(summaries, p, kind.name.c_str())});
      }
      effects.push_back(effect_of(kind, values));
    }
  }
  std::vector<Defined<TTest>> tests;
  for (const HintEffect& each : effects) {
    tests.push_back(each.effect.test);
  }
  const std::vector<Defined<double>> adjusted = holm_over(tests);
  for (std::size_t i = 0; i < effects.size(); ++i) {
    effects[i].holm = adjusted[i];
  }
  return effects;
}

void add_hint_section(Document& document, std::span<const HintProcedure> hints,
                      std::span<const HintEffect> effects, bool simulated) {
  if (hints.empty()) {
    return;
  }
  document.heading(simulated ? "Hints (simulated)" : "Hints");
  document.paragraph(
      "A hint begins with several removals within a moment that had more force, or more speed, "
      "than nearly all of the experts' at that distance from a structure, or that other bone hid. "
      "Hints are recorded whether the participant saw them or not, so that conditions can be "
      "compared.");
  std::vector<HintRowText> rows;
  for (const std::string& condition : conditions_of(hints)) {
    for (const HintKind kind : hint::kAllHintKinds) {
      rows.push_back(row_of(condition, kind, sum_of(hints, condition, kind)));
    }
  }
  document.table({"condition", "hint", "procedures", "drilling [min]", "hints",
                  "hints a minute of drilling", "removals that they were about", "they lasted [s]"},
                 rows);
  if (effects.empty()) {
    return;
  }
  std::vector<HintRowText> changes;
  for (const HintEffect& each : effects) {
    changes.push_back({fmt::format("{} ({})", each.title, each.unit),
                       difference_word(each.effect, each.unit == "1" ? "" : each.unit.c_str()),
                       word(each.holm)});
  }
  document.table(
      {"with hints less without, participants' means", "result, p not adjusted", "p after Holm"},
      changes);
}

std::vector<std::string> hint_lines(std::span<const HintProcedure> hints,
                                    std::span<const HintEffect> effects) {
  std::vector<std::string> lines;
  for (const std::string& condition : conditions_of(hints)) {
    HintSum all;
    for (const HintKind kind : hint::kAllHintKinds) {
      const HintSum sum = sum_of(hints, condition, kind);
      all.procedures = sum.procedures;
      all.minutes = sum.minutes;
      all.counts.hints += sum.counts.hints;
    }
    lines.push_back(fmt::format("{}: {} hints in {} procedures, {:.1f} min of drilling", condition,
                                all.counts.hints, all.procedures, all.minutes));
  }
  if (!effects.empty()) {
    lines.push_back("hints a minute of drilling with hints less without: " +
                    difference_word(effects.front().effect, effects.front().unit.c_str()));
  }
  return lines;
}

}  // namespace haptrial::analysis::drilling
