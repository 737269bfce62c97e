#include "experiments/studies/trials_analysis.h"

#include <algorithm>

#include "core/base/definition/table.h"
#include "core/base/error.h"
#include "experiments/studies/reaching/reach_ways.h"
#include "protocols/trials/definition/trials_definition.h"
#include "protocols/trials/trials_protocol.h"

namespace haptrial::experiments {
namespace {

using analysis::trials::AnalysisKind;
using analysis::trials::PlanDefaults;

/// 1 / choices where a procedure learns whether the first answer was right; nothing where an answer
/// "yes", or a formula of it, is what counts.
std::optional<double> guess_of(const protocols::TrialsDefinition& d) {
  const bool formula = std::any_of(d.tracks.begin(), d.tracks.end(),
                                   [](const auto& track) { return !track.counts.empty(); });
  if (formula || d.questions.empty() || d.questions.front().correct.empty() ||
      d.questions.front().choices.size() < 2) {
    return std::nullopt;
  }
  return 1.0 / static_cast<double>(d.questions.front().choices.size());
}

void add_names(const protocols::TrialsDefinition& d, PlanDefaults& defaults) {
  for (const protocols::Factor& factor : d.order.factors) {
    defaults.factors.push_back(factor.name);
  }
  if (d.groups.size() > 1) {
    defaults.factors.emplace_back("group");
  }
  defaults.names = {"condition", "block", "track", "probe", "group"};
  for (const protocols::Block& block : d.order.blocks) {
    for (const protocols::GivenValue& value : block.values) {
      defaults.names.push_back(value.name);
    }
  }
}

/// The axis that a procedure states, whatever its kind.
void take_axis(Table& root, psychometric::Axis& axis) {
  if (!root.has("procedure")) {
    return;
  }
  Table procedure = root.table("procedure");
  if (procedure.has("scale")) {
    const std::string scale = procedure.choice("scale", {"linear", "log10", "decibel"});
    axis.scale = scale == "log10"     ? psychometric::Scale::kLog10
                 : scale == "decibel" ? psychometric::Scale::kDecibel
                                      : psychometric::Scale::kLinear;
  }
  if (procedure.has("origin")) {
    axis.origin = procedure.number("origin", {}, "");
  }
}

}  // namespace

PlanDefaults plan_defaults(const protocols::TrialsDefinition& d) {
  PlanDefaults defaults;
  add_names(d, defaults);
  defaults.reaching = reaching_names(d);
  for (std::size_t i = 1; i < d.questions.size() && defaults.rating.empty(); ++i) {
    defaults.rating = d.questions[i].correct.empty() ? d.questions[i].name : std::string();
  }
  if (d.tracks.empty()) {
    return defaults;
  }
  const protocols::Track& track = d.tracks.front();
  defaults.kind = track.kind == "magnitude"    ? AnalysisKind::kMagnitude
                  : track.kind == "adjustment" ? AnalysisKind::kAdjustment
                                               : AnalysisKind::kPsychometric;
  defaults.guess = guess_of(d);
  if (track.staircase) {
    defaults.axis = track.staircase->axis;
  }
  defaults.axis.unit = track.unit;
  return defaults;
}

analysis::trials::TrialsPlan read_trials_analysis(Table& root) {
  PlanDefaults defaults;
  try {
    // A document of its own: what is wrong with it was noted by who read the definition.
    Table copy = Table::parse(root.source(), "");
    const auto definition = protocols::trials_protocol().read(copy, "", nullptr);
    defaults = plan_defaults(dynamic_cast<const protocols::TrialsDefinition&>(*definition));
    take_axis(copy, defaults.axis);
  } catch (const InputError&) {
    defaults = {};
  }
  return analysis::trials::read_trials_plan(root, defaults);
}

analysis::trials::ProcedureOf procedures_of(const protocols::TrialsDefinition& definition) {
  return [&definition](const std::string& name) -> std::unique_ptr<psychometric::Procedure> {
    for (const protocols::Track& track : definition.tracks) {
      const bool own = name == track.name || name.starts_with(track.name + ", ");
      if (own && !track.listed && track.begin) {
        return track.begin(1, name);
      }
    }
    return nullptr;
  };
}

}  // namespace haptrial::experiments
