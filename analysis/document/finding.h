#pragma once

#include <concepts>
#include <cstdint>
#include <limits>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "analysis/document/document.h"

namespace haptrial::analysis {

class Staging;

/// How a finding stands in JSON under its name.
enum class JsonForm {
  kDescribed,  // {"title": …, "estimate": …, "low_95": …, "high_95": …, "unit": …, "n": …}
  kAbsent,     // nowhere
  kPlain,      // "area": 0.8
  kEstimate,  // "width": {"estimate": 1.2, "low_95": 0.9, "high_95": 1.5}
  kBeside,    // "d_prime": 1.2, "d_prime_low_95": 0.9, "d_prime_high_95": 1.5
};

/// A number, a count or a word; empty: there is none.
class FindingValue {
 public:
  FindingValue() = default;
  FindingValue(double number) : value_(number) {}
  FindingValue(std::integral auto count) : value_(static_cast<std::int64_t>(count)) {}
  FindingValue(std::string word) : value_(std::move(word)) {}
  FindingValue(const char* word) : value_(std::string(word)) {}

  const double* number() const { return std::get_if<double>(&value_); }
  double as_number() const;  // of a count, too; NaN: there is none
  const std::int64_t* count() const { return std::get_if<std::int64_t>(&value_); }
  const std::string* word() const { return std::get_if<std::string>(&value_); }

 private:
  std::variant<std::monostate, double, std::int64_t, std::string> value_;
};

/// One result of an analysis, or a word that says whose result it is. Reports, JSON, CSV and the
/// terminal print findings; an analysis states each once.
struct Finding {
  static constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

  std::string name;                // JSON pointer without its first '/': "detection/d_prime"
  std::string title{};             // column of a report; empty: not in one
  FindingValue value{};            // [unit]
  double low{kNone}, high{kNone};  // 95 %; NaN: not known; infinite: open
  std::string unit{};              // empty: a pure number
  std::size_t n{0};                // participants or trials behind it; 0: not stated
  std::string why_not{};           // completes "not defined, because"; empty: there is a value
  std::string csv{};               // its name in a table of estimates; empty: not there
  JsonForm form{JsonForm::kDescribed};
  std::string json{};  // text of a list or an object that JSON alone shows in place of the value
};

/// A finding whose value alone stands in JSON.
Finding plain_finding(std::string name, std::string title, FindingValue value,
                      std::string unit = {});

/// Findings that belong together, as those of a participant under a condition.
using FindingRow = std::vector<Finding>;

/// A table of a report, a list of objects in JSON. A title that comes again in a row begins another
/// line of the report's table, on which the columns before it are repeated.
struct FindingTable {
  std::string name;
  std::string title;
  std::vector<FindingRow> rows{};
  bool in_lines{false};  // the terminal, too, has every row in words, not their number alone
  bool folded{false};    // in the report, under its title
};

/// Findings under a heading: a line each, then tables, blocks and figures.
struct FindingList {
  std::string name;  // its key in JSON
  std::string heading;
  FindingRow findings{};
  std::vector<FindingTable> tables{};
  std::vector<Figure> figures{};
  std::vector<Document::Block> blocks{};  // below the tables, in the report alone
  bool opens{false};                      // stands before everything else in the report

  /// Whether more than its blocks is there.
  bool has_values() const;
};

/// "Way of the hand: 0.3120 [0.2900, 0.3340] m (n = 12)".
std::string line_of(const Finding& finding);
/// A line for each finding with a title.
std::vector<std::string> lines_of(const FindingRow& row);
/// These lines, and how long each table is.
std::vector<std::string> lines_of(const FindingList& list);

/// The table of those findings that have a title. Columns that are empty in every row are left out.
/// @param folded  under the table's title
void add_table(Document& document, const FindingTable& table, bool folded);
/// Heading, lines, tables, and pictures of the figures of lists, before the document's methods; of
/// a list that opens the report at its beginning, after its alarms.
/// @param drawings  those of the figures are among them, by name; they outlive the document
void add_findings(Document& document, const std::vector<FindingList>& lists,
                  const std::vector<Drawing>& drawings);

/// A column of a CSV file that says whose estimate a row is, and the finding that it shows.
using CsvLabel = std::pair<std::string, std::string>;

/// Estimates as CSV: a row for each finite number with a name there, with the labels that stand
/// before it in its row of findings. Columns are the labels, then name, estimate, low, high (95 %)
/// and unit.
std::string findings_csv(const std::vector<FindingTable>& tables,
                         const std::vector<CsvLabel>& labels);

/// Writes own_findings.csv if there are lists, and adds their figures to those to be drawn.
void write_findings(const std::vector<FindingList>& lists, const Staging& staging,
                    std::vector<Figure>& figures);

}  // namespace haptrial::analysis
