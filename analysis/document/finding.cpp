#include "analysis/document/finding.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "analysis/document/number.h"
#include "analysis/files/delimited.h"
#include "analysis/files/staging.h"

namespace haptrial::analysis {
namespace {

/// The value as a report shows it, without its unit.
std::string word_of(const Finding& f) {
  if (!f.why_not.empty()) {
    return "not defined, because " + f.why_not;
  }
  if (const double* number = f.value.number()) {
    return number_with_interval(*number, f.low, f.high);
  }
  const std::int64_t* count = f.value.count();
  return count != nullptr            ? std::to_string(*count)
         : f.value.word() != nullptr ? *f.value.word()
                                     : "–";
}

double number_of(const Finding& f) {
  return f.why_not.empty() ? f.value.as_number() : Finding::kNone;
}

/// "threshold [95 %] (N/m)".
std::string heading_of(const Finding& f, bool interval) {
  return f.title + (interval ? " [95 %]" : "") + (f.unit.empty() ? "" : " (" + f.unit + ")");
}

/// Columns of a report's table, filled cell by cell.
class TableText {
 public:
  void add(const FindingRow& row) {
    begin_line(0);
    for (const Finding& f : row) {
      if (f.title.empty()) {
        continue;
      }
      const std::size_t column = column_of(f);
      if (!lines_.back()[column].empty()) {
        begin_line(column);
      }
      lines_.back()[column] = word_of(f);
    }
  }
  void write(Document& document, const std::string& folded_under) {
    std::vector<std::string> heading;
    std::vector<std::vector<std::string>> rows(lines_.size());
    for (std::size_t c = 0; c < columns_.size(); ++c) {
      if (std::ranges::all_of(
              lines_, [&](const auto& line) { return line.size() <= c || line[c].empty(); })) {
        continue;
      }
      heading.push_back(heading_of(columns_[c], intervals_[c]));
      for (std::size_t r = 0; r < rows.size(); ++r) {
        const bool there = c < lines_[r].size() && !lines_[r][c].empty();
        rows[r].push_back(there ? lines_[r][c] : "–");
      }
    }
    document.table(heading, rows, folded_under);
  }

 private:
  /// @param kept  columns that the new line has in common with the one before
  void begin_line(std::size_t kept) {
    std::vector<std::string> line(kept);
    std::copy_n(lines_.empty() ? line.begin() : lines_.back().begin(), kept, line.begin());
    line.resize(columns_.size());
    lines_.push_back(std::move(line));
  }
  std::size_t column_of(const Finding& f) {
    const auto found = std::ranges::find(columns_, f.title, &Finding::title);
    const auto column = static_cast<std::size_t>(found - columns_.begin());
    if (found == columns_.end()) {
      columns_.push_back(f);
      intervals_.push_back(false);
    }
    lines_.back().resize(columns_.size());
    intervals_[column] = intervals_[column] || (!std::isnan(f.low) && !std::isnan(f.high));
    return column;
  }

  std::vector<Finding> columns_;  // the first finding of each
  std::vector<bool> intervals_;
  std::vector<std::vector<std::string>> lines_;
};

}  // namespace

double FindingValue::as_number() const {
  const std::int64_t* whole = count();
  return number() != nullptr ? *number()
         : whole != nullptr  ? static_cast<double>(*whole)
                             : Finding::kNone;
}

Finding plain_finding(std::string name, std::string title, FindingValue value, std::string unit) {
  Finding finding{std::move(name), std::move(title), std::move(value)};
  finding.unit = std::move(unit);
  finding.form = JsonForm::kPlain;
  return finding;
}

std::string line_of(const Finding& f) {
  return fmt::format("{}: {}{}{}", f.title, word_of(f),
                     f.unit.empty() || std::isnan(number_of(f)) ? "" : " " + f.unit,
                     f.n > 0 ? fmt::format(" (n = {})", f.n) : "");
}

std::vector<std::string> lines_of(const FindingRow& row) {
  std::vector<std::string> lines;
  for (const Finding& f : row) {
    if (!f.title.empty()) {
      lines.push_back(line_of(f));
    }
  }
  return lines;
}

std::vector<std::string> lines_of(const FindingList& list) {
  std::vector<std::string> lines = lines_of(list.findings);
  for (const FindingTable& table : list.tables) {
    if (!table.in_lines) {
      lines.push_back(fmt::format("{}: {} rows", table.title, table.rows.size()));
    }
    for (const FindingRow& row : table.in_lines ? table.rows : std::vector<FindingRow>{}) {
      lines.push_back(fmt::format("{}", fmt::join(lines_of(row), "; ")));
    }
  }
  return lines;
}

void add_table(Document& document, const FindingTable& table, bool folded) {
  TableText text;
  for (const FindingRow& row : table.rows) {
    text.add(row);
  }
  text.write(document, folded ? table.title : "");
}

static void add_list(Document& part, const FindingList& list,
                     const std::vector<Drawing>& drawings) {
  part.heading(list.heading);
  if (const std::vector<std::string> lines = lines_of(list.findings); !lines.empty()) {
    part.points(lines);
  }
  for (const FindingTable& table : list.tables) {
    if (!table.folded && !table.title.empty()) {
      part.subheading(table.title);
    }
    add_table(part, table, table.folded);
  }
  part.blocks.insert(part.blocks.end(), list.blocks.begin(), list.blocks.end());
  for (const Figure& figure : list.figures) {
    const auto named = [&](const Drawing& d) { return d.figure.name == figure.name; };
    part.picture(*std::ranges::find_if(drawings, named));
  }
}

void add_findings(Document& document, const std::vector<FindingList>& lists,
                  const std::vector<Drawing>& drawings) {
  Document opening, part;
  for (const FindingList& list : lists) {
    add_list(list.opens ? opening : part, list, drawings);
  }
  const auto methods = std::ranges::find_if(document.blocks, [](const Document::Block& block) {
    const auto* heading = std::get_if<Document::Heading>(&block);
    return heading != nullptr && heading->level == 2 && heading->text.starts_with("Methods");
  });
  document.blocks.insert(methods, part.blocks.begin(), part.blocks.end());
  const auto first = std::ranges::find_if_not(document.blocks, [](const Document::Block& block) {
    return std::holds_alternative<Document::Alarm>(block);
  });
  document.blocks.insert(first, opening.blocks.begin(), opening.blocks.end());
}

std::string findings_csv(const std::vector<FindingTable>& tables,
                         const std::vector<CsvLabel>& labels) {
  std::string text;
  exchange::RowText row(text, exchange::Delimited::kCsv);
  for (const CsvLabel& label : labels) {
    row.add(label.first);
  }
  row.add("name").add("estimate").add("low").add("high").add("unit").end();
  const auto add = [&](const FindingRow& findings) {
    std::map<std::string, std::string> words;
    for (const Finding& f : findings) {
      if (const std::string* word = f.value.word()) {
        words[f.name] = *word;
      }
      const double number = number_of(f);
      if (f.csv.empty() || !std::isfinite(number)) {
        continue;
      }
      for (const CsvLabel& label : labels) {
        row.add(words[label.second]);
      }
      row.add(f.csv).add(number).add(f.low).add(f.high).add(f.unit).end();
    }
  };
  for (const FindingTable& table : tables) {
    std::ranges::for_each(table.rows, add);
  }
  return text;
}

bool FindingList::has_values() const {
  const bool found = std::ranges::any_of(
      findings, [](const Finding& each) { return each.form != JsonForm::kAbsent; });
  return found || !tables.empty() || !figures.empty();
}

void write_findings(const std::vector<FindingList>& lists, const Staging& staging,
                    std::vector<Figure>& figures) {
  std::vector<FindingTable> tables;
  std::vector<CsvLabel> labels;
  const auto add = [&](const FindingTable& table) {
    tables.push_back(table);
    for (const FindingRow& row : table.rows) {
      for (const Finding& f : row) {
        const auto found = std::ranges::find(labels, f.name, &CsvLabel::first);
        if (f.value.word() != nullptr && found == labels.end()) {
          labels.emplace_back(f.name, f.name);
        }
      }
    }
  };
  for (const FindingList& list : lists) {
    add({list.name, "", {list.findings}});
    std::ranges::for_each(list.tables, add);
    figures.insert(figures.end(), list.figures.begin(), list.figures.end());
  }
  if (std::ranges::any_of(lists, &FindingList::has_values)) {
    staging.write("own_findings.csv", findings_csv(tables, labels));
  }
}

}  // namespace haptrial::analysis
