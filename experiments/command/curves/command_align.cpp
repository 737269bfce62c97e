#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <iterator>

#include "analysis/document/figure_gnuplot.h"
#include "analysis/files/new_folder.h"
#include "analysis/force_training/exchange/import_checks.h"
#include "analysis/force_training/report/recall_frequency_findings.h"
#include "analysis/force_training/score/curve_csv.h"
#include "analysis/force_training/score/score.h"
#include "core/base/error.h"
#include "core/base/nearest.h"
#include "experiments/command/arguments.h"
#include "experiments/command/subcommand.h"

namespace haptrial::experiments {
namespace {

struct AlignOptions {
  std::string target;
  std::string applied;
  std::string time;
  std::string value;
  std::string applied_value;
  std::optional<double> rate;
  int samples{1000};
  double filter{0.1};
  double power{1.0};
  double slope_weight{0.5};
  std::optional<double> penalty;
  std::string pattern{"published"};
  std::optional<double> window;
  bool open_begin{false};
  bool open_end{false};
  std::string out;
};

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

}  // namespace

void add_align(CLI::App& app, int& status) {
  CLI::App* sub = subcommand(
      app, "align", "Align two curves from any source (.csv) and score the second",
      "haptrial align target.csv applied.csv --value force --out aligned",
      {"tables and a picture in the folder of --out", "algorithms/alignment-options.md"});
  auto& o = options_of<AlignOptions>(*sub, status, align);
  sub->add_option("TARGET", o.target, "Table of the target curve (.csv), or - for standard input")
      ->required();
  sub->add_option("APPLIED", o.applied,
                  "Table of the applied curve (.csv), or - for standard input")
      ->required();
  sub->add_option("--time", o.time, "Column of times [s], by name or number (default: time)");
  sub->add_option("--rate", o.rate, "Rows per second [Hz], in place of a column of times");
  sub->add_option("--value", o.value,
                  "Column of values, by name or number (default: the only one besides the times)");
  sub->add_option("--applied-value", o.applied_value,
                  "Column of values of APPLIED (default: as --value)");
  sub->add_option("--samples", o.samples,
                  with_default("Number of samples of the common time base", o.samples));
  sub->add_option("--filter", o.filter,
                  with_default("Width of the box filter on APPLIED [s]", o.filter));
  sub->add_option("--power", o.power,
                  with_default("Exponent of the differences, 1 or more", o.power));
  sub->add_option("--slope-weight", o.slope_weight,
                  with_default("Weight of the differences of slopes", o.slope_weight));
  sub->add_option("--penalty", o.penalty,
                  fmt::format("Penalty for a step off the diagonal (default: {} with the published "
                              "pattern, otherwise 0)",
                              AlignmentOptions{}.penalty));
  sub->add_option(
      "--pattern", o.pattern,
      with_default("Step pattern: published, symmetric1, symmetric2, asymmetric or symmetricP1",
                   o.pattern));
  sub->add_option("--window", o.window,
                  "Largest time difference of paired samples [s] (default: no limit)");
  sub->add_flag("--open-begin", o.open_begin, "Allow APPLIED to begin before the match");
  sub->add_flag("--open-end", o.open_end, "Allow APPLIED to continue after the match");
  sub->add_option("--out", o.out, "New folder for the aligned curves, their path and a picture");
}

}  // namespace haptrial::experiments
