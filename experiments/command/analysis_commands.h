#pragma once

#include <optional>
#include <string>
#include <vector>

namespace haptrial::experiments {

// Each subcommand prints to standard output and returns an exit status. Bad input and failures come
// as InputError and RunError.

struct AnalyzeOptions {
  std::string folder;  // of session files; else the ones below
  std::string curves;  // folder of curves that something else recorded
  std::string conditions;
  std::string table;  // one table of all samples, in place of the two
  std::string out;
  std::string definition;            // for its [analysis]; default: as shipped
  std::vector<std::string> columns;  // "subject=Participant", of curves and table
  std::vector<std::string> factors;  // columns of the table; default: condition
  bool pilots{false};                // them alone, in place of the study
  std::vector<std::string> planned;  // in place of the definition's
  std::string reference;             // likewise
  std::optional<int> paper;          // width of figures as PDF [mm]
  std::optional<int> jobs;
};
int analyze(const AnalyzeOptions& options);

/// The tests that the design of a table calls for.
struct StatisticsOptions {
  std::string table;
  std::vector<std::string> subject;  // columns; default: subject
  std::vector<std::string> factors;  // default: condition
  std::vector<std::string> between;  // factors of which a participant has one level
  bool leave_out_missing{false};
  std::string value{"score"};
  std::vector<std::string> planned;
  std::string reference;
  int resamples{9999};
  std::string seed{"1"};
  std::string json;  // file for the numbers
  std::optional<int> jobs;
};
int statistics(const StatisticsOptions& options);

/// Exactly one of bids, csv and curves names a new folder.
struct ExportOptions {
  std::vector<std::string> files;  // session files, or folders of them
  std::string bids;
  std::string csv;
  std::string curves;
  bool samples{false};               // of csv: every tick as well
  std::string name;                  // of the BIDS data set; default: the experiment's
  std::vector<std::string> authors;  // of the BIDS data set
  std::optional<int> jobs;
};
int export_sessions(const ExportOptions& options);

/// Two curves of any origin (.csv).
struct AlignOptions {
  std::string target;         // "-": standard input
  std::string applied;        // likewise, but not both
  std::string time;           // name of a column in both; see analysis::CurveColumns
  std::string value;          // likewise
  std::string applied_value;  // where the applied curve's name is another
  std::optional<double> rate;
  int samples{1000};
  double filter{0.1};
  double power{1.0};
  double slope_weight{0.5};
  std::optional<double> penalty;  // default: as the pattern is known
  std::string pattern{"published"};
  std::optional<double> window;
  bool open_begin{false};
  bool open_end{false};
  std::string out;  // new folder; empty: nothing is written
};
int align(const AlignOptions& options);

/// Two analysed studies.
struct CompareOptions {
  std::string first;  // folder
  std::string second;
  std::string out;                // folder for the page, the figure and the numbers; empty: none
  bool different_scoring{false};  // allowed, with an alarm
};
int compare(const CompareOptions& options);

/// Two of an effect (delta and sd, or f), n and power; the third is computed.
struct PowerOptions {
  std::string test;                   // "t", "anova", "repeated"
  std::optional<std::string> design;  // of t: "two-sample" by default, "paired", "one-sample"
  std::optional<double> delta;        // difference of the means
  double sd{1.0};                     // in the same unit; of paired values that of the differences
  std::optional<double> f;            // of anova and repeated: Cohen's
  std::optional<int> groups;          // of anova; of repeated 1 if left out
  std::optional<std::string> effect;  // of repeated: "within" by default, "interaction", "between"
  std::optional<int> measurements;    // of repeated: conditions that everybody has
  std::optional<double> correlation;  // of repeated: of any two measurements
  std::optional<double> epsilon;      // of repeated: Greenhouse and Geisser's
  std::optional<long> n;              // participants in each group
  std::optional<double> power;
  double alpha{0.05};
  bool one_tailed{false};
};
int power(const PowerOptions& options);

}  // namespace haptrial::experiments
