#include "analysis/bone_drilling/report/learned_quantities.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "analysis/bone_drilling/metrics/quantities.h"
#include "core/base/error.h"

namespace haptrial::analysis::drilling {
namespace {

/// Title and unit of a quantity that some procedure has.
void describe(std::span<const ProcedureSummary> procedures, LearningQuantity& outcome) {
  for (const MetricKind& kind : metric_kinds()) {
    if (kind.name == outcome.name) {
      outcome.title = kind.title;
      outcome.unit = kind.unit;
    }
  }
  for (const ProcedureSummary& p : procedures) {
    for (const AchievedFigure& figure : figures_of(p.achieved)) {
      if (figure.column == outcome.name) {
        outcome.title = figure.title;
        outcome.unit = figure.unit;
      }
    }
  }
  if (outcome.title.empty()) {
    throw InputError(
        fmt::format("analysis.outcomes names '{}', which no procedure has; allowed: {}",
                    outcome.name, fmt::join(quantity_names(procedures.front()), ", ")));
  }
}

std::vector<Observation> observations_of(std::span<const ProcedureSummary> procedures,
                                         const std::string& name) {
  std::vector<Observation> observations;
  for (const ProcedureSummary& p : procedures) {
    if (const auto value = quantity(p, name)) {
      const std::string session =
          p.session_name.empty() ? std::to_string(p.session_number) : p.session_name;
      observations.push_back({p.participant, {p.group, session}, *value});
    }
  }
  return observations;
}

}  // namespace

LearningOutcomes drilling_outcomes() { return {quantity_names(), is_quantity}; }

std::vector<LearningQuantity> learned_quantities(std::span<const ProcedureSummary> procedures,
                                                 const std::vector<std::string>& outcomes) {
  std::vector<LearningQuantity> quantities;
  for (const std::string& name : outcomes) {
    LearningQuantity& outcome = quantities.emplace_back();
    outcome.name = name;
    describe(procedures, outcome);
    outcome.values = observations_of(procedures, name);
  }
  return quantities;
}

}  // namespace haptrial::analysis::drilling
