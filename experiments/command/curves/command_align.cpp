#include <fmt/format.h>

#include <filesystem>
#include <iterator>

#include "analysis/document/figure_gnuplot.h"
#include "analysis/files/new_folder.h"
#include "analysis/force_training/exchange/import_checks.h"
#include "analysis/force_training/report/recall_figure.h"
#include "analysis/force_training/score/curve_csv.h"
#include "analysis/force_training/score/score.h"
#include "core/base/error.h"
#include "core/base/nearest.h"
#include "experiments/command/analysis_commands.h"
#include "experiments/command/arguments.h"

namespace haptrial::experiments {
namespace {

using analysis::AlignmentOptions;
using analysis::RecallDetail;
using analysis::ScoreParameters;
using analysis::StepPattern;
using analysis::TableCurve;

constexpr double kMostWeight = 1e6;

StepPattern checked_pattern(const std::string& name) {
  const auto pattern = analysis::pattern_of(name);
  if (!pattern) {
    throw InputError(
        not_allowed("--pattern", fmt::format("'{}'", name), analysis::pattern_names()));
  }
  return *pattern;
}

ScoreParameters parameters_of(const AlignOptions& o) {
  ScoreParameters p;
  p.samples = checked_number("--samples", o.samples, 2, 10000);
  p.filter_width = checked_real("--filter", o.filter, 0.0, 10.0);
  AlignmentOptions& a = p.alignment;
  a.pattern = checked_pattern(o.pattern);
  a.power = checked_real("--power", o.power, 1.0, 100.0);
  a.slope_weight = checked_real("--slope-weight", o.slope_weight, 0.0, kMostWeight);
  // The patterns of the literature have none.
  const double usual = a.pattern == StepPattern::kPublished ? a.penalty : 0.0;
  a.penalty = checked_real("--penalty", o.penalty.value_or(usual), 0.0, kMostWeight);
  if (o.window) {
    p.window = checked_real("--window", *o.window, 0.0, 1e9);
  }
  a.open_begin = o.open_begin;
  a.open_end = o.open_end;
  if (o.open_begin && analysis::doubles_straight(a.pattern)) {
    throw InputError(
        fmt::format("--open-begin is given with --pattern {}, whose cost grows with every applied "
                    "sample that is paired, so that leaving some out always looks cheaper; choose "
                    "published, symmetric1 or asymmetric",
                    o.pattern));
  }
  return p;
}

TableCurve curve_of(const std::string& file, const std::string& value, const AlignOptions& o) {
  return analysis::read_curve(analysis::CsvTable::load(file), {o.time, value, o.rate});
}

std::string aligned_csv(const RecallDetail& r) {
  std::string text = "time,target,applied,applied_warped\n";
  for (std::size_t k = 0; k < r.time.samples; ++k) {
    fmt::format_to(std::back_inserter(text), "{},{},{},{}\n",
                   r.time.step() * static_cast<double>(k), r.target[k], r.applied[k], r.warped[k]);
  }
  return text;
}

std::string path_csv(const RecallDetail& r) {
  std::string text = "target_time,applied_time,target,applied\n";
  for (const auto& [target, applied] : r.path) {
    fmt::format_to(std::back_inserter(text), "{},{},{},{}\n", r.time.step() * target,
                   r.time.step() * applied, r.target[target], r.applied[applied]);
  }
  return text;
}

void write(const RecallDetail& recall, const std::string& out) {
  exchange::NewFolder folder(out);
  folder.write("aligned.csv", aligned_csv(recall));
  folder.write("path.csv", path_csv(recall));
  analysis::draw_figures({analysis::recall_figure(recall, "")},
                         folder.place("aligned.csv").parent_path());
  folder.publish();
}

void print(const RecallDetail& recall, const ScoreParameters& p) {
  const auto& score = recall.score;
  fmt::print("score           {:.6g}\n", score.score);
  fmt::print("alignment_cost  {:.6g}\n", score.alignment_cost);
  fmt::print("rms_force       {:.6g}\n", score.rms_force);
  fmt::print("rms_slope       {:.6g}\n", score.rms_slope);
  fmt::print("rms_unaligned   {:.6g}\n", score.rms_unaligned);
  const auto& first = recall.path.front();
  const auto& last = recall.path.back();
  const double step = recall.time.step();
  fmt::print("path            {} pairs over {:.6g} s", recall.path.size(), recall.time.duration);
  if (p.alignment.open_begin || p.alignment.open_end) {
    fmt::print(", applied curve from {:.6g} s to {:.6g} s", step * first.applied,
               step * last.applied);
  }
  fmt::print("\n");
}

}  // namespace

int align(const AlignOptions& options) {
  if (options.target == "-" && options.applied == "-") {
    throw InputError("TARGET and APPLIED are both '-'; read only one of them from standard input");
  }
  const ScoreParameters parameters = parameters_of(options);
  const TableCurve target = curve_of(options.target, options.value, options);
  const TableCurve applied =
      curve_of(options.applied,
               options.applied_value.empty() ? options.value : options.applied_value, options);
  const RecallDetail recall = analysis::align_curves(target.view(), applied.view(), parameters);
  if (!options.out.empty()) {
    write(recall, options.out);
  }
  print(recall, parameters);
  // Not on standard output, which programs read.
  if (const std::string warning = exchange::time_warning(target, applied); !warning.empty()) {
    fmt::print(stderr, "{}\n", warning);
  }
  return 0;
}

}  // namespace haptrial::experiments
