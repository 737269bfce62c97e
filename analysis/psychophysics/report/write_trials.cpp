#include "analysis/psychophysics/report/write_trials.h"

#include <cstdint>
#include <optional>
#include <string>

#include "analysis/document/figure_gnuplot.h"
#include "analysis/files/delimited.h"
#include "analysis/files/staging.h"
#include "analysis/psychophysics/data/trials_csv.h"
#include "analysis/psychophysics/report/report_surfaces.h"
#include "analysis/psychophysics/report/trials_figures.h"
#include "analysis/psychophysics/report/trials_findings.h"
#include "analysis/psychophysics/report/trials_json.h"
#include "analysis/psychophysics/report/trials_report.h"
#include "core/base/file_text.h"

namespace haptrial::analysis::trials {
namespace {

using exchange::RowText;

constexpr const char* kHeading =
    "participant,group,session,file,trial,order,block,probe,kind,start_x_m,start_y_m,"
    "start_z_m,target_x_m,target_y_m,target_z_m,field_active,perturbation,push,recorded,"
    "arrived,onset_s,movement_time_s,peak_speed_m_per_s,path_length_m,"
    "maximum_perpendicular_error_m,perpendicular_error_at_150_ms_m,"
    "direction_error_at_150_ms_rad,signed_area_m2,endpoint_error_m,mean_lateral_force_N,"
    "peak_lateral_force_N,force_compensation,force_compensation_se,saturated,no_onset,"
    "moving_at_start,anticipated,never_slowed,missed_target\n";

const char* word_of(ReachKind kind) {
  return kind == ReachKind::kClamp ? "clamp" : kind == ReachKind::kCatch ? "catch" : "plain";
}

RowText& add_optional(RowText& row, const std::optional<double>& value) {
  return value ? row.add(*value) : row.add_missing();
}

void add_metrics(RowText& row, const StudyReach& reach) {
  const ReachMetrics& m = reach.metrics;
  for (const auto& value :
       {m.reaction_time, m.movement_time, m.peak_speed, m.path_length,
        m.maximum_perpendicular_error, reach.error_at_150_ms, m.direction_error, m.signed_area,
        m.endpoint_error, m.mean_lateral_force, m.peak_lateral_force}) {
    add_optional(row, value);
  }
  if (reach.compensation) {
    row.add(reach.compensation->slope).add(reach.compensation->slope_error);
  } else {
    row.add_missing().add_missing();
  }
  if (!reach.recorded) {
    for (int i = 0; i < 6; ++i) {
      row.add_missing();
    }
    return;
  }
  row.add(reach.saturated);
  for (const bool flag : {m.flags.no_onset, m.flags.moving_at_start, m.flags.anticipated,
                          m.flags.never_slowed, m.flags.missed_target}) {
    row.add(flag ? 1 : 0);
  }
}

/// A tidy table with a row for every reach: who, which trial, its kind (plain, catch, clamp), how
/// it went. Lateral columns are positive to the left of the way from start to target, seen from
/// above; `push` is the side (1 left, -1 right) to which the participant's field pushes. Units are
/// in the names; what is not defined is empty. Empty text without an analysis of reaches.
std::string reaches_csv(const TrialsResult& result) {
  if (!result.reaching) {
    return {};
  }
  std::string text = kHeading;
  RowText row(text, exchange::Delimited::kCsv);
  for (const StudyReach& reach : result.reaching->reaches) {
    const StudyTrial& trial = result.data.trials[reach.trial];
    const StudySession& session = result.data.session_of(trial);
    row.add(session.participant).add(session.group).add(session.session).add(session.file);
    row.add(trial.trial).add(static_cast<std::uint64_t>(reach.order)).add(reach.block);
    row.add(trial.probe).add(word_of(reach.kind));
    for (const Eigen::Vector3d& place : {reach.way.start, reach.way.target}) {
      row.add(place.x()).add(place.y()).add(place.z());
    }
    row.add(reach.way.active ? 1 : 0).add(reach.perturbation).add(reach.push);
    row.add(reach.recorded ? 1 : 0).add(reach.arrived ? 1 : 0);
    add_metrics(row, reach);
    row.end();
  }
  return text;
}

}  // namespace

void write_trials(const TrialsResult& result, const std::filesystem::path& folder, int paper,
                  const std::vector<FindingList>& own) {
  const Staging staging(folder);
  trials_csv(result.data, [&](const std::string& text) { staging.append("trials.csv", text); });
  staging.write("estimates.csv", estimates_csv(result));
  staging.write("results.json", results_json(result, own));
  if (!result.surfaces.empty()) {
    staging.write("surfaces.csv", surfaces_csv(result));
  }
  if (result.reaching) {
    staging.write("reaches.csv", reaches_csv(result));
  }
  std::vector<Figure> figures = trials_figures(result);
  write_findings(own, staging, figures);
  draw_figures(figures, staging.path(), paper);
  std::vector<Drawing> drawings;
  for (const Figure& figure : figures) {
    drawings.push_back({figure, file_text(staging.path() / (figure.name + ".svg"))});
  }
  Document report = trials_report(result, drawings);
  add_findings(report, own, drawings);
  staging.write("report.html", to_html(report));
  staging.write("report.md", to_markdown(report));
  staging.publish();
}

}  // namespace haptrial::analysis::trials
