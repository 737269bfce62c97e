// What was recorded, here or elsewhere: scores, tests, other programs' forms; sizes of studies.
#include "experiments/command_line_internal.h"

namespace haptrial::experiments {

void add_analyze(CLI::App& app, int& status) {
  CLI::App* sub =
      subcommand(app, "analyze", "Score and test the sessions of a folder; write the report",
                 "haptrial analyze out/force_training-001");
  auto& o = options_of<AnalyzeOptions>(*sub, status, analyze);
  sub->add_option("DIR", o.folder, "Folder of session files (.h5)");
  sub->add_flag("--pilots", o.pilots,
                "Analyse the pilot sessions of DIR alone; the report goes into DIR/pilots");
  sub->add_option("--curves", o.curves,
                  "Folder of curves from another system (.csv), in place of DIR");
  sub->add_option("--conditions", o.conditions, "Table of the trials of --curves (.csv)");
  sub->add_option("--table", o.table,
                  "Table of all samples from another system (.csv), in place of DIR");
  sub->add_option("--out", o.out, "Folder for the report of --curves or --table");
  sub->add_option("--definition", o.definition,
                  "Definition that says how --curves or --table are scored (as shipped)");
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
  sub->add_option("--jobs", o.jobs, "Threads; one per processor by default");
}

void add_export(CLI::App& app, int& status) {
  CLI::App* sub = subcommand(app, "export", "Write sessions in the forms of other programs",
                             "haptrial export --bids data-set out/force_training-001");
  auto& o = options_of<ExportOptions>(*sub, status, export_sessions);
  sub->add_option("FILE", o.files, "Session files (.h5), or folders of them")->required();
  sub->add_option("--bids", o.bids, "New folder for a BIDS data set");
  sub->add_option("--csv", o.csv, "New folder for tidy tables (.csv)");
  sub->add_option("--curves", o.curves, "New folder for the scored curves (.csv)");
  sub->add_flag("--samples", o.samples, "With --csv: every tick as well (.csv.gz)");
  sub->add_option("--name", o.name, "With --bids: of the data set");
  sub->add_option("--author", o.authors, "With --bids: of the data set; may be repeated")
      ->allow_extra_args(false);
  sub->add_option("--jobs", o.jobs, "Threads; one per processor by default");
}

void add_align(CLI::App& app, int& status) {
  CLI::App* sub =
      subcommand(app, "align", "Align two curves of any origin (.csv) and score the second",
                 "haptrial align target.csv applied.csv --value force --out aligned");
  auto& o = options_of<AlignOptions>(*sub, status, align);
  sub->add_option("TARGET", o.target,
                  "Table of the target curve (.csv); - reads standard "
                  "input")
      ->required();
  sub->add_option("APPLIED", o.applied, "Table of the applied curve")->required();
  sub->add_option("--time", o.time, "Column of times in s, by name or number (time)");
  sub->add_option("--rate", o.rate, "Rows a second, in place of a column of times");
  sub->add_option("--value", o.value, "Column of values (the only other one)");
  sub->add_option("--applied-value", o.applied_value, "The same of APPLIED (as --value)");
  sub->add_option("--samples", o.samples, "Of the common time base (1000)");
  sub->add_option("--filter", o.filter, "Width of the box filter on APPLIED in s (0.1)");
  sub->add_option("--power", o.power, "Of the differences, 1 or more (1)");
  sub->add_option("--slope-weight", o.slope_weight, "Of differences of slopes (0.5)");
  sub->add_option("--penalty", o.penalty,
                  "Of a step that is not straight (0.5 with the published pattern, else 0)");
  sub->add_option("--pattern", o.pattern,
                  "published, symmetric1, symmetric2, asymmetric or symmetricP1 (published)");
  sub->add_option("--window", o.window, "Pair no samples farther apart than so many s");
  sub->add_flag("--open-begin", o.open_begin, "APPLIED may begin before the match does");
  sub->add_flag("--open-end", o.open_end, "APPLIED may go on after the match");
  sub->add_option("--out", o.out, "New folder for the aligned curves, path and picture");
}

void add_compare(CLI::App& app, int& status) {
  CLI::App* sub = subcommand(
      app, "compare", "Compare the scores of two analysed studies",
      "haptrial compare results/force_training results/force_training_curve --out out/compared");
  auto& o = options_of<CompareOptions>(*sub, status, compare);
  sub->add_option("FIRST", o.first, "Folder of the first analysed study")->required();
  sub->add_option("SECOND", o.second, "Folder of the second analysed study")->required();
  sub->add_option("--out", o.out, "Folder for a page, a figure and the numbers");
  sub->add_flag("--different-scoring", o.different_scoring,
                "Compare scores that were made with different parameters, with an alarm on top");
}

void add_statistics(CLI::App& app, int& status) {
  CLI::App* sub = subcommand(app, "statistics",
                             "Test a table with one value in each row, as its design calls for",
                             "haptrial statistics scores.csv --planned 'visual < haptic'");
  auto& o = options_of<StatisticsOptions>(*sub, status, statistics);
  sub->add_option("TABLE", o.table, "Table (.csv); - reads standard input")->required();
  sub->add_option("--value", o.value, "Column of the values (score)");
  sub->add_option("--subject", o.subject, "Column of the participants (subject)");
  sub->add_option("--factor", o.factors, "Column of a factor; may be repeated (condition)")
      ->allow_extra_args(false);
  sub->add_option("--planned", o.planned,
                  "Planned test, 'A < B', 'A > B' or 'A != B'; may be repeated")
      ->allow_extra_args(false);
  sub->add_option("--reference", o.reference, "Level that tables and comparisons begin with");
  sub->add_option("--resamples", o.resamples,
                  "Random arrangements and resamples; 0 for none (9999)");
  sub->add_option("--seed", o.seed, "Seed of the random arrangements (1)");
  sub->add_option("--json", o.json, "File for the numbers, unrounded");
  sub->add_option("--jobs", o.jobs, "Threads; one per processor by default");
}

void add_power(CLI::App& app, int& status) {
  CLI::App* sub = subcommand(app, "power", "Say how many participants a study needs",
                             "haptrial power t --design paired --delta 20 --sd 35 --power 0.8");
  auto& o = options_of<PowerOptions>(*sub, status, power);
  sub->add_option("TEST", o.test, "t or anova (one way)")->required();
  sub->add_option("--design", o.design, "Of t: two-sample (default), paired, one-sample");
  sub->add_option("--delta", o.delta, "Of t: the difference to find");
  sub->add_option("--sd", o.sd, "In the unit of --delta; with paired that of the differences (1)");
  sub->add_option("--f", o.f, "Of anova: deviation of the groups' means by that within");
  sub->add_option("--groups", o.groups, "Of anova: how many");
  sub->add_option("--n", o.n, "Participants in each group");
  sub->add_option("--power", o.power, "Chance of finding the effect");
  sub->add_option("--alpha", o.alpha, "Chance of finding one that is none (0.05)");
  sub->add_flag("--one-tailed", o.one_tailed, "Of t: the sign of the difference is planned");
}

}  // namespace haptrial::experiments
