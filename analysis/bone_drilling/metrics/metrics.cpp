#include "analysis/bone_drilling/metrics/metrics.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <limits>
#include <set>
#include <stdexcept>
#include <utility>

#include "analysis/bone_drilling/metrics/drilling_meter.h"
#include "analysis/bone_drilling/metrics/in_order.h"
#include "analysis/files/delimited.h"

namespace haptrial::analysis::drilling {
namespace {

/// Quantities from which scalars are computed.
struct Parts {
  const Procedure& procedure;
  const ProcedureSummary& summary;
  const NearRemovals& near;  // any of the structures
  double within;             // [m]
};

using Value = std::optional<double>;

Value scaled(const Value& value, double factor) {
  return value ? Value(*value * factor) : std::nullopt;
}

Value count(std::uint64_t number) { return static_cast<double>(number); }

/// Those of vital structures; a tear of soft tissue that is not vital stands among all. Nothing
/// where it is not known what is vital.
std::optional<std::vector<Injury>> vital_injuries(const Parts& p) {
  std::vector<Injury> vital = p.summary.injuries;
  std::erase_if(vital, [&](const Injury& injury) {
    return !p.procedure.bone->structures.at(injury.label).vital;
  });
  return vital.empty() ? std::nullopt : std::optional(std::move(vital));
}

Value injured_voxels(const Parts& p) {
  const auto injuries = vital_injuries(p);
  if (!injuries) {
    return std::nullopt;
  }
  std::uint64_t sum = 0;
  for (const Injury& injury : *injuries) {
    sum += injury.voxels;
  }
  return count(sum);
}

Value injured_structures(const Parts& p) {
  const auto injuries = vital_injuries(p);
  if (!injuries) {
    return std::nullopt;
  }
  std::set<std::string> injured;  // bones of old sessions have several labels of one name
  for (const Injury& injury : *injuries) {
    if (injury.voxels > 0 || injury.tears > 0) {
      injured.insert(injury.structure);
    }
  }
  return count(injured.size());
}

/// Mean diameter over the time of drilling; exactly that of a burr which alone drilled.
Value mean_burr_diameter(const Parts& p) {
  double sum = 0.0;
  double time = 0.0;
  double least = std::numeric_limits<double>::infinity(), greatest = 0.0;
  for (std::size_t tool = 0; tool < p.procedure.tools.size(); ++tool) {
    const double diameter = 2.0 * p.procedure.tools[tool].burr_radius;
    const double drilling = p.summary.usage.tools[tool].drilling;
    if (drilling > 0.0) {
      sum += diameter * drilling;
      time += drilling;
      least = std::min(least, diameter);
      greatest = std::max(greatest, diameter);
    }
  }
  // Rounding would otherwise give everybody with one burr a diameter of their own.
  return time > 0.0 ? Value(std::clamp(1e3 * sum / time, 1e3 * least, 1e3 * greatest))
                    : std::nullopt;
}

struct Definition {
  const char* name;
  const char* unit;
  const char* title;
  Expected experts;
  Value (*value)(const Parts&);
};

const std::array kDefinitions{
    Definition{"visible_share", "1", "share of voxels removed in sight", Expected::kHigher,
               [](const Parts& p) { return p.summary.visibility.share(); }},
    Definition{"near_force", "N", "force near vital structures", Expected::kLower,
               [](const Parts& p) { return p.near.mean_force(p.within); }},
    Definition{"near_speed", "mm/s", "speed near vital structures", Expected::kLower,
               [](const Parts& p) { return scaled(p.near.mean_speed(p.within), 1e3); }},
    Definition{kRegionMetric, "1", "log likelihood ratio of the removed region", Expected::kHigher,
               [](const Parts&) { return Value(); }},
    Definition{"injured_voxels", "1", "voxels of vital structures removed", Expected::kLower,
               injured_voxels},
    Definition{"injured_structures", "1", "vital structures injured", Expected::kLower,
               injured_structures},
    Definition{"time", "s", "time", Expected::kEither,
               [](const Parts& p) { return Value(p.summary.usage.time); }},
    Definition{"drilling_time", "s", "time of drilling", Expected::kEither,
               [](const Parts& p) { return Value(p.summary.usage.drilling); }},
    Definition{"removed", "mm3", "bone removed", Expected::kEither,
               [](const Parts& p) { return Value(1e9 * p.summary.usage.removed); }},
    Definition{"mean_force", "N", "mean force while drilling", Expected::kEither,
               [](const Parts& p) { return p.summary.usage.mean_force; }},
    Definition{"greatest_force", "N", "greatest force while drilling", Expected::kEither,
               [](const Parts& p) { return p.summary.usage.greatest_force; }},
    Definition{"strokes", "1", "strokes", Expected::kEither,
               [](const Parts& p) { return count(p.summary.strokes.count); }},
    Definition{"stroke_rate", "1/s", "strokes per second of drilling", Expected::kEither,
               [](const Parts& p) { return p.summary.strokes.rate; }},
    Definition{"stroke_length", "mm", "length of strokes", Expected::kEither,
               [](const Parts& p) { return scaled(p.summary.strokes.length, 1e3); }},
    Definition{"stroke_speed", "mm/s", "speed of strokes", Expected::kEither,
               [](const Parts& p) { return scaled(p.summary.strokes.speed, 1e3); }},
    Definition{"stroke_duration", "s", "duration of strokes", Expected::kEither,
               [](const Parts& p) { return p.summary.strokes.duration; }},
    Definition{"stroke_smoothness", "1", "smoothness of strokes (log dimensionless jerk)",
               Expected::kHigher, [](const Parts& p) { return p.summary.strokes.smoothness; }},
    Definition{"tool_changes", "1", "tool changes", Expected::kEither,
               [](const Parts& p) {
                 return count(static_cast<std::uint64_t>(p.summary.usage.tool_changes));
               }},
    Definition{"burr_diameter", "mm", "diameter of the burr, mean over the time of drilling",
               Expected::kEither, mean_burr_diameter},
    Definition{"camera_path", "mm", "path of the eye", Expected::kEither,
               [](const Parts& p) { return Value(1e3 * p.summary.usage.camera_path); }},
    Definition{"camera_moves", "1", "changes of the view", Expected::kEither,
               [](const Parts& p) {
                 return count(static_cast<std::uint64_t>(p.summary.usage.camera_moves));
               }},
};

std::size_t place_of(std::string_view metric) {
  for (std::size_t i = 0; i < kDefinitions.size(); ++i) {
    if (kDefinitions[i].name == metric) {
      return i;
    }
  }
  throw std::invalid_argument("no metric is called '" + std::string(metric) + "'");
}

/// The voxels in ascending order, each once, and whether they were visible.
void sort_removed(const Procedure& procedure, ProcedureSummary& summary) {
  const geometry::VoxelGrid& grid = procedure.bone->grid;
  std::vector<std::pair<std::uint32_t, std::uint8_t>> voxels;
  voxels.reserve(procedure.removals.size());
  for (std::size_t n = 0; n < procedure.removals.size(); ++n) {
    const bone::Voxel& v = procedure.removals[n].voxel;
    if (grid.contains(v)) {
      voxels.emplace_back(static_cast<std::uint32_t>(grid.index(v)), summary.visibility.visible[n]);
    }
  }
  std::sort(voxels.begin(), voxels.end());
  for (const auto& [voxel, seen] : voxels) {
    if (summary.removed.empty() || summary.removed.back() != voxel) {
      summary.removed.push_back(voxel);
      summary.removed_seen.push_back(seen);
    }
  }
}

/// Structures that were asked for, or all that are vital, by name.
std::vector<std::string> structures_of(const bone::BoneModel& bone, const MetricOptions& options) {
  std::vector<std::string> names = options.structures;
  if (names.empty()) {
    for (const bone::Structure& structure : bone.structures) {
      if (structure.vital && std::find(names.begin(), names.end(), structure.name) == names.end()) {
        names.push_back(structure.name);
      }
    }
  }
  return names;
}

/// Near each structure as far as the bins reach, and near any of them as far as `near` does.
NearRemovals measure_near(const Procedure& procedure, const MetricOptions& options,
                          StudyBones& bones, std::vector<NearRemovals>& each) {
  const bone::BoneModel& bone = *procedure.bone;
  const double most = 250.0 * bone.grid.spacing;
  std::vector<bool> any(bone.structures.size(), false);
  for (const std::string& name : structures_of(bone, options)) {
    std::vector<bool> labels(bone.structures.size(), false);
    for (std::size_t label = 1; label < labels.size(); ++label) {
      labels[label] = bone.structures[label].name == name;
      any[label] = any[label] || labels[label];
    }
    const double reach = std::min(options.bins.reach, most);
    each.push_back(
        near_removals(procedure, name, *bones.field(procedure.bone, labels, reach), reach));
  }
  const double reach = std::min(options.near, most);
  return near_removals(procedure, "", *bones.field(procedure.bone, any, reach), reach);
}

std::string column_name(const Definition& definition) {
  std::string unit = definition.unit;
  if (unit == "1") {
    return definition.name;
  }
  if (const std::size_t slash = unit.find('/'); slash != std::string::npos) {
    unit = (slash == 1 && unit[0] == '1' ? "" : unit.substr(0, slash) + "_") + "per_" +
           unit.substr(slash + 1);
  }
  return std::string(definition.name) + "_" + unit;
}

/// Columns of what was achieved: bones of one study may have different structures.
std::vector<std::string> achieved_columns(std::span<const ProcedureSummary> procedures) {
  std::vector<std::string> columns;
  for (const ProcedureSummary& p : procedures) {
    for (const AchievedFigure& figure : figures_of(p.achieved)) {
      if (std::find(columns.begin(), columns.end(), figure.column) == columns.end()) {
        columns.push_back(figure.column);
      }
    }
  }
  return columns;
}

/// "phase_upper_third_s".
std::string phase_column(std::string phase) {
  std::replace(phase.begin(), phase.end(), ' ', '_');
  return fmt::format("phase_{}_s", phase);
}

std::vector<std::string> phases_of(std::span<const ProcedureSummary> procedures) {
  std::vector<std::vector<PhaseSpan>> all;
  for (const ProcedureSummary& p : procedures) {
    if (!p.phases.empty()) {
      all.push_back(p.phases);
    }
  }
  return phases_in_order(all);
}

void add_phases(const ProcedureSummary& p, const std::vector<std::string>& phases,
                exchange::RowText& row) {
  for (const std::string& phase : phases) {
    p.phases.empty() ? row.add_missing() : row.add(time_in(p.phases, phase));
  }
  if (!phases.empty()) {
    p.phases.empty() ? row.add_missing() : row.add(phase_changes(p.phases));
  }
}

/// Nothing where the bones differ: their voxels are not the same places.
std::optional<std::vector<RemovedRegion>> regions_of(std::span<const ProcedureSummary> procedures,
                                                     std::span<const std::string> expert_groups) {
  std::vector<RemovedRegion> regions;
  for (const ProcedureSummary& p : procedures) {
    if (p.bone->grid.size != procedures.front().bone->grid.size ||
        p.bone->labels != procedures.front().bone->labels) {
      return std::nullopt;
    }
    const bool expert =
        std::find(expert_groups.begin(), expert_groups.end(), p.group) != expert_groups.end();
    regions.push_back({p.participant, expert, p.removed});
  }
  return regions;
}

}  // namespace

std::vector<MetricKind> metric_kinds() {
  std::vector<MetricKind> kinds;
  for (const Definition& d : kDefinitions) {
    kinds.push_back({d.name, d.unit, d.title, d.experts});
  }
  return kinds;
}

std::optional<double> ProcedureSummary::value(std::string_view metric) const {
  return values.at(place_of(metric));
}

ProcedureSummary summarize(const Procedure& procedure, const MetricOptions& options,
                           StudyBones& bones) {
  ProcedureSummary summary;
  static_cast<ProcedureIdentity&>(summary) = procedure;
  DrillingMeter meter(procedure.bone, procedure.pose_WB, procedure.tools, procedure.rate, bones,
                      procedure.plans);
  visit_in_order(procedure, meter);
  for (const record::PieceRow& row : procedure.pieces) {
    meter.add(row);
  }
  for (const record::ScrewRow& row : procedure.screws) {
    meter.add(row);
  }
  summary.visibility = meter.visibility();
  sort_removed(procedure, summary);
  summary.injuries = meter.injuries().injuries();
  add_tears(procedure, summary.injuries);
  summary.usage = meter.usage();
  summary.achieved = meter.achieved();
  summary.strokes = stroke_figures(procedure, options.strokes);
  if (options.phases) {
    summary.phases = options.phases(procedure, bones);
  }
  const NearRemovals near = measure_near(procedure, options, bones, summary.near);
  const Parts parts{procedure, summary, near, options.near};
  std::vector<std::optional<double>> values;
  for (const Definition& definition : kDefinitions) {
    values.push_back(definition.value(parts));
  }
  summary.values = std::move(values);
  return summary;
}

std::optional<double> quantity(const ProcedureSummary& summary, std::string_view name) {
  for (std::size_t i = 0; i < kDefinitions.size(); ++i) {
    if (kDefinitions[i].name == name) {
      return summary.values.at(i);
    }
  }
  for (const AchievedFigure& figure : figures_of(summary.achieved)) {
    if (figure.column == name) {
      return figure.value;
    }
  }
  return std::nullopt;
}

std::optional<double> judged_quantity(const ProcedureSummary& summary, std::string_view name) {
  for (const AchievedFigure& figure : figures_of(summary.achieved)) {
    if (figure.column == name && figure.measured_to_reach && !figure.value) {
      return std::numeric_limits<double>::infinity();
    }
  }
  return quantity(summary, name);
}

std::vector<std::string> quantity_names(const ProcedureSummary& summary) {
  std::vector<std::string> names;
  for (const Definition& definition : kDefinitions) {
    names.emplace_back(definition.name);
  }
  for (const AchievedFigure& figure : figures_of(summary.achieved)) {
    names.push_back(figure.column);
  }
  return names;
}

std::vector<RegionScores> add_region_scores(std::span<ProcedureSummary> procedures,
                                            std::span<const std::string> expert_groups) {
  std::vector<RegionScores> scores(procedures.size());
  if (const auto regions = regions_of(procedures, expert_groups)) {
    scores = region_scores(*regions);
  }
  const std::size_t place = place_of(kRegionMetric);
  for (std::size_t i = 0; i < procedures.size(); ++i) {
    procedures[i].values.at(place) = scores[i].score;
  }
  return scores;
}

std::optional<RegionLabelTest> region_label_test(std::span<const ProcedureSummary> procedures,
                                                 std::span<const std::string> expert_groups) {
  constexpr int kRounds = 999;  // least p: 0.001, which Holm's adjustment leaves below 0.05
  constexpr std::uint64_t kSeed = 1;
  const auto regions = regions_of(procedures, expert_groups);
  return regions ? region_label_test(*regions, kSeed, kRounds) : std::nullopt;
}

std::string metrics_csv(std::span<const ProcedureSummary> procedures) {
  std::string text;
  exchange::RowText row(text, exchange::Delimited::kCsv);
  for (const char* name :
       {"session", "participant", "group", "procedure", "simulated", "completed"}) {
    row.add(std::string_view(name));
  }
  const bool several = std::ranges::any_of(
      procedures, [](const ProcedureSummary& p) { return p.session_number > 1; });
  if (several) {
    row.add("session_number").add("session_name");
  }
  const bool cases = std::ranges::any_of(
      procedures, [](const ProcedureSummary& p) { return !p.case_name.empty(); });
  if (cases) {
    row.add("case");
  }
  for (const Definition& definition : kDefinitions) {
    row.add(std::string_view(column_name(definition)));
  }
  const std::vector<std::string> achieved = achieved_columns(procedures);
  for (const std::string& column : achieved) {
    row.add(std::string_view(column));
  }
  const std::vector<std::string> phases = phases_of(procedures);
  for (const std::string& phase : phases) {
    row.add(std::string_view(phase_column(phase)));
  }
  if (!phases.empty()) {
    row.add(std::string_view("phase_changes"));
  }
  row.end();
  for (const ProcedureSummary& p : procedures) {
    row.add(std::string_view(p.session)).add(std::string_view(p.participant));
    row.add(std::string_view(p.group)).add(p.number);
    row.add(p.simulated ? 1 : 0).add(p.completed ? 1 : 0);
    if (several) {
      row.add(p.session_number).add(std::string_view(p.session_name));
    }
    if (cases) {
      row.add(std::string_view(p.case_name));
    }
    for (const std::optional<double>& value : p.values) {
      value ? row.add(*value) : row.add_missing();
    }
    const std::vector<AchievedFigure> figures = figures_of(p.achieved);
    for (const std::string& column : achieved) {
      const auto at = std::find_if(figures.begin(), figures.end(),
                                   [&](const auto& each) { return each.column == column; });
      at != figures.end() && at->value ? row.add(*at->value) : row.add_missing();
    }
    add_phases(p, phases, row);
    row.end();
  }
  return text;
}

}  // namespace haptrial::analysis::drilling
