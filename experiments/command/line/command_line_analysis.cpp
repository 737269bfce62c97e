// Commands on recorded data, of here or elsewhere: scores, tests, other programs' forms; sizes of
// studies.
#include "experiments/command/analysis_commands.h"
#include "experiments/command/line/command_lines.h"
#include "experiments/command/line/subcommand_internal.h"

namespace haptrial::experiments {

void add_analyze(CLI::App& app, int& status) {
  CLI::App* sub = subcommand(
      app, "analyze", "Score and test the sessions of a folder and write the report",
      "haptrial analyze out/force_training-001",
      {"scores.csv, statistics.json, figures and report.html in DIR", "guide-analyst.md"});
  auto& o = options_of<AnalyzeOptions>(*sub, status, analyze);
  sub->add_option("DIR", o.folder, "Folder of session files (.h5)");
  sub->add_flag("--pilots", o.pilots,
                "Analyse only the pilot sessions of DIR; the report goes into DIR/pilots");
  sub->add_option("--curves", o.curves,
                  "Folder of curves from another system (.csv), in place of DIR");
  sub->add_option("--conditions", o.conditions,
                  "Table of the trials of --curves and their conditions (.csv)");
  sub->add_option("--table", o.table,
                  "Table of all samples from another system (.csv), in place of DIR");
  sub->add_option("--out", o.out, "Folder for the report of --curves or --table");
  sub->add_option("--definition", o.definition,
                  "Definition by which --curves or --table are scored (default: as shipped)");
  sub->add_option("--column", o.columns,
                  "Name of a column of --curves or --table, as in subject=Participant; may be "
                  "repeated")
      ->allow_extra_args(false);
  sub->add_option("--factor", o.factors,
                  "Column of a factor, in place of condition; may be repeated")
      ->allow_extra_args(false);
  sub->add_option("--planned", o.planned,
                  "Planned test in place of the definition's, 'A < B', 'A > B' or 'A != B'; may be "
                  "repeated")
      ->allow_extra_args(false);
  sub->add_option("--reference", o.reference, "Reference condition in place of the definition's");
  sub->add_option("--paper", o.paper,
                  "Width [mm] of figures for a paper, such as 85: PDF in 8 pt, without titles "
                  "(default: none are written)");
  sub->add_option("--jobs", o.jobs, "Number of threads (default: one per processor)");
}

void add_export(CLI::App& app, int& status) {
  CLI::App* sub =
      subcommand(app, "export", "Write sessions in the formats of other programs",
                 "haptrial export --bids data-set out/force_training-001",
                 {"the folder that --bids, --csv or --curves names", "guide-analyst.md"});
  auto& o = options_of<ExportOptions>(*sub, status, export_sessions);
  sub->add_option("FILE", o.files, "Session file (.h5) or folder of session files; may be repeated")
      ->required();
  sub->add_option("--bids", o.bids, "New folder for a BIDS data set");
  sub->add_option("--csv", o.csv, "New folder for tidy tables (.csv)");
  sub->add_option("--curves", o.curves, "New folder for the scored curves (.csv)");
  sub->add_flag("--samples", o.samples,
                "Samples of every tick beside the tables of --csv (.csv.gz)");
  sub->add_option("--name", o.name,
                  "Name of the BIDS data set (default: the name of the experiment)");
  sub->add_option("--author", o.authors, "Author of the BIDS data set; may be repeated")
      ->allow_extra_args(false);
  sub->add_option("--jobs", o.jobs, "Number of threads (default: one per processor)");
}

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
                  "Number of samples of the common time base (default: 1000)");
  sub->add_option("--filter", o.filter, "Width of the box filter on APPLIED [s] (default: 0.1)");
  sub->add_option("--power", o.power, "Exponent of the differences, 1 or more (default: 1)");
  sub->add_option("--slope-weight", o.slope_weight,
                  "Weight of the differences of slopes (default: 0.5)");
  sub->add_option(
      "--penalty", o.penalty,
      "Penalty for a step off the diagonal (default: 0.5 with the published pattern, otherwise "
      "0)");
  sub->add_option(
      "--pattern", o.pattern,
      "Step pattern: published, symmetric1, symmetric2, asymmetric or symmetricP1 (default: "
      "published)");
  sub->add_option("--window", o.window,
                  "Largest time difference of paired samples [s] (default: no limit)");
  sub->add_flag("--open-begin", o.open_begin, "Allow APPLIED to begin before the match");
  sub->add_flag("--open-end", o.open_end, "Allow APPLIED to continue after the match");
  sub->add_option("--out", o.out, "New folder for the aligned curves, their path and a picture");
}

void add_compare(CLI::App& app, int& status) {
  CLI::App* sub = subcommand(
      app, "compare", "Compare the scores of two analysed studies",
      "haptrial compare results/force_training results/force_training_curve --out out/compared",
      {"a report, a figure and the numbers in the folder of --out", "guide-analyst.md"});
  auto& o = options_of<CompareOptions>(*sub, status, compare);
  sub->add_option("FIRST", o.first, "Folder of the first analysed study")->required();
  sub->add_option("SECOND", o.second, "Folder of the second analysed study")->required();
  sub->add_option("--out", o.out, "Folder for the comparison: a report, a figure and the numbers");
  sub->add_flag("--different-scoring", o.different_scoring,
                "Compare scores made with different parameters, with a warning on top");
}

void add_statistics(CLI::App& app, int& status) {
  CLI::App* sub = subcommand(app, "statistics",
                             "Test a table with one value in each row, as its design calls for",
                             "haptrial statistics scores.csv --planned 'visual < haptic'",
                             {"", "algorithms/statistics.md"});
  auto& o = options_of<StatisticsOptions>(*sub, status, statistics);
  sub->add_option("TABLE", o.table, "Table (.csv), or - for standard input")->required();
  sub->add_option("--value", o.value, "Column of the values (default: score)");
  sub->add_option("--subject", o.subject,
                  "Column of the participants (default: subject); may be repeated, with the column "
                  "of the group if each group numbers its people anew")
      ->allow_extra_args(false);
  sub->add_option("--factor", o.factors, "Column of a factor; may be repeated (default: condition)")
      ->allow_extra_args(false);
  sub->add_flag("--leave-out-missing", o.leave_out_missing,
                "Leave out and count rows with a field that is empty, NA, NaN, N/A or '.'");
  sub->add_option("--between", o.between,
                  "Factor of which each participant has one level; may be repeated")
      ->allow_extra_args(false);
  sub->add_option("--planned", o.planned,
                  "Planned test, 'A < B', 'A > B' or 'A != B'; may be repeated")
      ->allow_extra_args(false);
  sub->add_option("--reference", o.reference, "Level that tables and comparisons begin with");
  sub->add_option("--resamples", o.resamples,
                  "Number of random arrangements and resamples; 0 for none (default: 9999)");
  sub->add_option("--seed", o.seed, "Seed of the random arrangements (default: 1)");
  sub->add_option("--json", o.json, "File for the unrounded numbers (.json)");
  sub->add_option("--jobs", o.jobs, "Number of threads (default: one per processor)");
}

void add_power(CLI::App& app, int& status) {
  CLI::App* sub = subcommand(app, "power",
                             "Compute the participants, the effect or the power of a planned study",
                             "haptrial power t --design paired --delta 20 --sd 35 --power 0.8",
                             {"", "algorithms/power.md"});
  auto options = std::make_shared<PowerOptions>();
  sub->callback([options, &status, sub] {
    if (sub->get_subcommands().empty()) {
      status = power(*options);
    }
  });
  PowerOptions& o = *options;
  sub->add_option("TEST", o.test,
                  "Test: t, anova (one-way) or repeated (repeated measures and mixed designs)");
  sub->add_option("--design", o.design,
                  "Design of the t test: two-sample, paired or one-sample (default: two-sample)");
  sub->add_option("--delta", o.delta, "Difference of the means to detect (t test)");
  sub->add_option(
      "--sd", o.sd,
      "Standard deviation, of the differences if paired, in the unit of --delta (default: 1)");
  sub->add_option(
      "--f", o.f,
      "Effect size f: standard deviation of the means over that within a cell (anova, repeated)");
  sub->add_option("--groups", o.groups, "Number of groups (anova; repeated, default: 1)");
  sub->add_option("--effect", o.effect,
                  "Effect: within, interaction or between (repeated; default: within)");
  sub->add_option("--measurements", o.measurements,
                  "Number of conditions that everybody has (repeated)");
  sub->add_option("--correlation", o.correlation,
                  "Correlation of any two conditions over participants (repeated; default: 0.5)");
  sub->add_option("--epsilon", o.epsilon,
                  "Epsilon of Greenhouse and Geisser, 1 for a sphere (repeated; default: 1)");
  sub->add_option("--n", o.n, "Number of participants in each group");
  sub->add_option("--power", o.power, "Power: probability of detecting the effect");
  sub->add_option("--alpha", o.alpha, "Significance level: false-positive rate (default: 0.05)");
  sub->add_flag("--one-tailed", o.one_tailed,
                "Test one tail only; the sign of the difference was planned (t test)");
}

}  // namespace haptrial::experiments
