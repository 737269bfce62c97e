#include "analysis/bone_drilling/report/hint_findings.h"

#include <fmt/format.h>

#include <algorithm>

#include "analysis/bone_drilling/metrics/counted_passes.h"
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

}  // namespace haptrial::analysis::drilling
