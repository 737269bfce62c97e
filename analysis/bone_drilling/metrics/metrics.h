#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "analysis/bone_drilling/metrics/achieved.h"
#include "analysis/bone_drilling/metrics/injuries.h"
#include "analysis/bone_drilling/metrics/near_structure.h"
#include "analysis/bone_drilling/metrics/phase_span.h"
#include "analysis/bone_drilling/metrics/procedure.h"
#include "analysis/bone_drilling/metrics/region_likelihood.h"
#include "analysis/bone_drilling/metrics/strokes.h"
#include "analysis/bone_drilling/metrics/study_bones.h"
#include "analysis/bone_drilling/metrics/usage.h"
#include "analysis/bone_drilling/metrics/visibility.h"

namespace haptrial::analysis::drilling {

/// Which way the values of experts are expected to lie; kEither where nothing published says so.
enum class Expected : std::uint8_t { kHigher, kLower, kEither };

/// Raised whenever a metric, or a figure of what was achieved, gets another value for the same
/// session: a score that was learned before no longer fits.
inline constexpr int kMetricsVersion = 1;

/// Name, unit, title and expected direction of a scalar metric.
struct MetricKind {
  std::string name;   // a column's: "visible_share"
  std::string unit;   // "1", "N", "mm3", ...
  std::string title;  // for axes and tables: "bone removed in sight"
  Expected experts{Expected::kEither};
};

/// The name of the removed region's score, the one metric that needs the other procedures.
inline constexpr const char* kRegionMetric = "region_log_ratio";

/// All scalar metrics of a procedure, in the order of summaries, CSV and reports.
std::vector<MetricKind> metric_kinds();

struct MetricOptions {
  std::vector<std::string> structures;  // to look at forces near them; empty: all that are vital
  double near{5e-3};                    // how far from them is near > 0 [m]
  NearBins bins;                        // at most 250 voxels far
  StrokeParameters strokes;
  FindPhases phases;  // empty: procedures are not divided
};

/// Everything that a study keeps of a procedure: a few megabytes where the procedure has hundreds.
struct ProcedureSummary : ProcedureIdentity {
  std::vector<std::uint32_t> removed;  // voxels that a burr emptied, ascending index in the grid
  std::vector<std::uint8_t> removed_seen;  // (removed) 1: visible when it was removed
  Visibility visibility;
  std::vector<Injury> injuries;
  StrokeFigures strokes;
  Usage usage;
  Achieved achieved;
  /// Removals by structure of MetricOptions; a structure that this bone does not have has none.
  std::vector<NearRemovals> near;
  std::vector<PhaseSpan> phases;  // none: not divided
  /// (metric_kinds()); nothing where it is not defined, as the share of no voxels. That of the
  /// region is filled by add_region_scores().
  std::vector<std::optional<double>> values;

  /// @throws std::invalid_argument for a name that metric_kinds() does not have.

  std::optional<double> value(std::string_view metric) const;
};

/// A metric by its name, or a figure of what was achieved by its column; nothing where it is not
/// defined, or there is no such quantity.
std::optional<double> quantity(const ProcedureSummary& summary, std::string_view name);
/// quantity() for a judgement: infinity for bone left of which there is more than is measured.
std::optional<double> judged_quantity(const ProcedureSummary& summary, std::string_view name);
/// The names that quantity() knows of a procedure.
std::vector<std::string> quantity_names(const ProcedureSummary& summary);

/// All metrics of one procedure but those that need the others.
/// @param bones  for distance fields that several procedures on one bone share. Any thread.
ProcedureSummary summarize(const Procedure& procedure, const MetricOptions& options,
                           StudyBones& bones);

/// Fills "region_log_ratio" of every procedure, each scored without anything of its participant.
/// Not defined where a group has fewer than two participants or the bones differ.
/// @param expert_groups  names of the groups that are experts; all others are novices
/// @returns the scores by the other ways of training and counting, for the report
std::vector<RegionScores> add_region_scores(std::span<ProcedureSummary> procedures,
                                            std::span<const std::string> expert_groups);

/// Whether experts' "region_log_ratio" is higher than novices', with the labels of participants
/// permuted (region_likelihood.h): values that share their training need a test of their own.
/// Nothing where the score is not defined.
std::optional<RegionLabelTest> region_label_test(std::span<const ProcedureSummary> procedures,
                                                 std::span<const std::string> expert_groups);

/// A tidy table (RFC 4180 with LF): session, participant, group, procedure, simulated, completed,
/// and where participants come several times session_number and session_name, of a curriculum the
/// case;
/// then a column for each metric, named NAME_UNIT, for each of figures_of() and, where procedures
/// are divided, the time in each phase and the number of changes; empty where it is not defined.
std::string metrics_csv(std::span<const ProcedureSummary> procedures);

}  // namespace haptrial::analysis::drilling
